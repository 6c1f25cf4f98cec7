#include "daemon/web/archive.hpp"

#include <array>
#include <filesystem>
#include <fstream>
#include <future>
#include <string>
#include <thread>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <unistd.h>

#include "daemon/http/file_body.hpp"
#include "daemon/web/query.hpp"
#include "daemon/web/recording_list.hpp"
#include "tests/support/temporary_folder.hpp"

namespace yuragi::daemon::web {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;
using testing::Contains;
using testing::HasSubstr;
using testing::Pair;
using What = ArchiveRequest::What;

constexpr const char* kPart = "wall-20261123T000000Z.windlog";

class ArchiveTest : public testing::Test {
 protected:
  ArchiveTest() {
    write("wall.windlog", "written");
    write(kPart, "completed");
    write("wall-20261122T000000Z.windlog", "older");
    write("wall.windlog-wal", "beside it");
    write("other.windlog", "another's");
    write("wall.toml", "secret");
  }

  void write(const std::string& name, const std::string& text) const { std::ofstream(folder_.path() / name) << text; }

  ArchiveSettings settings(const std::string& script = "") const {
    return {.recording = folder_.path() / "wall.windlog",
            .configuration = folder_.path() / "wall.toml",
            .program = {"/bin/sh", "-c", script, "sh"}};
  }

  static http::Response ask(Archive& archive, What what, const std::string& name = "") {
    std::promise<http::Response> answered;
    archive.answer({.what = what, .name = name},
                   [&](http::Response response) { answered.set_value(std::move(response)); });
    return answered.get_future().get();
  }
  static Json ended(Archive& archive, const http::Response& started) {
    EXPECT_EQ(started.status, 202U) << started.body;
    const std::string id = Json::parse(started.body)["id"];
    while (true) {
      Json job = Json::parse(ask(archive, What::kJob, id).body);
      if (job["state"] != "running") return job;
      std::this_thread::yield();
    }
  }
  static std::string text_of(const http::Response& response) {
    const platform::Descriptor pipe(response.file->begin());
    std::string text;
    std::array<char, 4096> block{};
    for (ssize_t size = 0; (size = read(pipe.get(), block.data(), block.size())) > 0;)
      text.append(block.data(), static_cast<std::size_t>(size));
    return text;
  }

  test::TemporaryFolder folder_;
};

TEST_F(ArchiveTest, ListsTheFilesOfTheRecording_AndNothingElse) {
  Archive archive(settings());
  const Json list = Json::parse(ask(archive, What::kList).body)["recordings"];
  ASSERT_EQ(list.size(), 3U);
  EXPECT_EQ(list[0]["name"], "wall.windlog");
  EXPECT_EQ(list[0]["is_written"], true);
  EXPECT_EQ(list[0]["first_s"], nullptr) << "it cannot be read";
  EXPECT_EQ(list[1]["name"], kPart);
  EXPECT_EQ(list[1]["bytes"], 9);
  EXPECT_EQ(list[1]["is_written"], false);
  EXPECT_EQ(list[2]["name"], "wall-20261122T000000Z.windlog");
}

TEST_F(ArchiveTest, ADaemonThatRecordsNothing_HasNone) {
  Archive archive({});
  EXPECT_EQ(Json::parse(ask(archive, What::kList).body)["recordings"], Json::array());
  for (const What what : {What::kDownload, What::kVerify, What::kConfiguration})
    EXPECT_EQ(ask(archive, what, "").status, 404U);
}

TEST_F(ArchiveTest, SendsACompletedFile) {
  Archive archive(settings());
  const http::Response response = ask(archive, What::kDownload, kPart);
  ASSERT_EQ(response.status, 200U);
  EXPECT_EQ(response.content_type, "application/vnd.sqlite3");
  EXPECT_THAT(response.fields, Contains(Pair("Content-Disposition", HasSubstr(kPart))));
  EXPECT_EQ(text_of(response), "completed");
}

TEST_F(ArchiveTest, OnlySoManyFilesAreSentAtOnce) {
  Archive archive(settings());
  std::vector<http::Response> sent;
  for (std::size_t i = 0; i < Archive::kMaxDownloads; ++i) sent.push_back(ask(archive, What::kDownload, kPart));
  EXPECT_EQ(ask(archive, What::kDownload, kPart).status, 503U);
  sent.pop_back();
  EXPECT_EQ(ask(archive, What::kDownload, kPart).status, 200U);
}

TEST_F(ArchiveTest, AnotherName_IsNotFound) {
  fs::create_symlink(folder_.path() / "wall.toml", folder_.path() / "wall-20261121T000000Z.windlog");
  Archive archive(settings("echo started"));
  for (const std::string name :
       {"", ".", "..", "../wall.windlog", "./wall.windlog", "wall.toml", "other.windlog", "wall.windlog-wal",
        "/etc/passwd", "wall.windlog/", "WALL.windlog", "--help", "wall-20261121T000000Z.windlog"}) {
    EXPECT_EQ(ask(archive, What::kDownload, name).status, 404U) << name;
    if (name.starts_with("wall-")) continue;  // a link is verified, but not sent
    for (const What what : {What::kVerify, What::kReport, What::kCopy})
      EXPECT_EQ(ask(archive, what, name).status, 404U);
  }
}

TEST_F(ArchiveTest, TheFileThatIsWritten_IsCopied) {
  Archive archive(settings("for file; do :; done; printf copy > \"$file\""));
  const http::Response refusal = ask(archive, What::kDownload, "wall.windlog");
  EXPECT_EQ(refusal.status, 409U);
  EXPECT_THAT(refusal.body, HasSubstr("/api/v1/recordings/wall.windlog/copy"));
  const Json job = ended(archive, ask(archive, What::kCopy, "wall.windlog"));
  EXPECT_EQ(job["file"]["name"], "wall.windlog") << job;
  EXPECT_EQ(text_of(ask(archive, What::kJobFile, job["id"])), "copy");
  EXPECT_FALSE(fs::exists(folder_.path() / ".wall.windlog-copy"));
}

TEST_F(ArchiveTest, ACopyThatLeavesTooLittleRoom_IsRefused) {
  ArchiveSettings full = settings();
  full.least_free_bytes = 1UL << 60;
  Archive archive(full);
  EXPECT_EQ(ask(archive, What::kCopy, "wall.windlog").status, 409U);
}

TEST_F(ArchiveTest, JobsGetTheFile_AndTheirResultsNameNoFolder) {
  Archive archive(settings("printf '{\"called\": \"%s\"}' \"$*\"; exit 1"));
  const Json job = ended(archive, ask(archive, What::kVerify, kPart));
  EXPECT_EQ(job["state"], "done") << "damage is a finding";
  EXPECT_EQ(job["result"]["called"], "verify " + std::string(kPart) + " --json");
  EXPECT_EQ(ask(archive, What::kJobFile, job["id"]).status, 404U);
  EXPECT_EQ(ask(archive, What::kJob, "7").status, 404U);
}

TEST_F(ArchiveTest, AReport_IsShownWithoutScripts) {
  Archive archive(settings("for file; do :; done; printf '<html>' > \"$file\""));
  const Json job = ended(archive, ask(archive, What::kReport, kPart));
  const http::Response page = ask(archive, What::kJobFile, job["id"]);
  EXPECT_EQ(page.content_type, "text/html; charset=utf-8");
  EXPECT_THAT(page.fields, Contains(Pair("Content-Security-Policy", HasSubstr("sandbox"))));
  EXPECT_EQ(text_of(page), "<html>");
}

TEST_F(ArchiveTest, TheConfiguration_WithItsFindings) {
  Archive sound(settings("printf '{\"http\": {}}'; echo 'warning: others can read it' >&2"));
  const Json found = Json::parse(ask(sound, What::kConfiguration).body);
  EXPECT_EQ(found, Json({{"file", "wall.toml"},
                         {"is_valid", true},
                         {"findings", {"warning: others can read it"}},
                         {"configuration", {{"http", Json::object()}}}}));
  Archive mistaken(settings("echo 'wall.toml:3:1: hight: is not known' >&2; exit 78"));
  const Json refused = Json::parse(ask(mistaken, What::kConfiguration).body);
  EXPECT_EQ(refused["is_valid"], false);
  EXPECT_EQ(refused["configuration"], nullptr);
  EXPECT_EQ(refused["findings"][0], "wall.toml:3:1: hight: is not known");
}

TEST(PathDecoded, IsNothingForDamagedOnes) {
  EXPECT_EQ(path_decoded("wall%20of%2Flight.windlog"), "wall of/light.windlog");
  for (const char* damaged : {"%", "%2", "%zz", "a%+1"}) EXPECT_EQ(path_decoded(damaged), std::nullopt) << damaged;
}

}  // namespace
}  // namespace yuragi::daemon::web
