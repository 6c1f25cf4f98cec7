#include "daemon/web/installed_files.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/temporary_folder.hpp"

namespace yuragi::daemon::web {
namespace {

using testing::HasSubstr;

const InstalledFiles::Place kGuide = {.path = "/guide/", .what = "the guide", .remedy = "read the sources"};

class InstalledFilesTest : public testing::Test {
 protected:
  InstalledFilesTest() {
    for (const auto& [name, text] : {std::pair("index.html", "<p>all pages"), std::pair("sensors.html", "<p>sensors"),
                                     std::pair("guide.css", "a {}"), std::pair("secret.key", "secret")}) {
      std::ofstream(folder_ / name) << text;
    }
  }
  static http::Request get(const std::string& path) { return {.method = "GET", .path = path}; }

  const test::TemporaryFolder folder_;
};

TEST_F(InstalledFilesTest, HasThePagesOfItsFolder) {
  const InstalledFiles guide(kGuide, folder_.path());
  EXPECT_EQ(guide.answer(get("/guide/"))->body, "<p>all pages");
  EXPECT_EQ(guide.answer(get("/guide/sensors.html"))->body, "<p>sensors");
  EXPECT_EQ(guide.answer(get("/guide/sensors.html"))->content_type, "text/html; charset=utf-8");
  EXPECT_EQ(guide.answer(get("/guide/guide.css"))->content_type, "text/css; charset=utf-8");
}
TEST_F(InstalledFilesTest, ServesNoOtherFile) {
  const InstalledFiles guide(kGuide, folder_.path());
  for (const char* path : {"/guide/secret.key", "/guide/../secret.key", "/guide//etc/passwd", "/guide/nothing.html"}) {
    EXPECT_EQ(guide.answer(get(path))->status, 404U) << path;
  }
  EXPECT_THAT(guide.answer(get("/guide/nothing.html"))->body, HasSubstr("nothing.html"));
}
TEST_F(InstalledFilesTest, LeavesOtherRequestsToOthers) {
  const InstalledFiles guide(kGuide, folder_.path());
  EXPECT_FALSE(guide.answer(get("/guide")));
  EXPECT_FALSE(guide.answer(get("/healthz")));
  EXPECT_FALSE(guide.answer({.method = "POST", .path = "/guide/"}));
}
TEST_F(InstalledFilesTest, GivesTheReasonIfItIsNotInstalled) {
  for (const auto& folder : {std::filesystem::path(), folder_ / "missing"}) {
    const auto response = InstalledFiles(kGuide, folder).answer(get("/guide/"));
    EXPECT_EQ(response->status, 404U);
    EXPECT_THAT(response->body, HasSubstr("the guide is not installed beside this program; read the sources"));
  }
}

TEST_F(InstalledFilesTest, AreSentCompressedToThoseWhoTakeIt) {
  for (const auto& [name, text] : {std::pair("viewer.wasm", "program"), std::pair("viewer.wasm.br", "by brotli"),
                                   std::pair("viewer.wasm.gz", "by gzip")}) {
    std::ofstream(folder_ / name) << text;
  }
  const InstalledFiles files(kGuide, folder_.path());
  const auto body_for = [&](const std::string& accepted) {
    http::Request request = get("/guide/viewer.wasm");
    request.accept_encoding = accepted;
    const auto response = files.answer(request);
    EXPECT_EQ(response->content_type, "application/wasm") << accepted;
    return response->body;
  };
  EXPECT_EQ(body_for("gzip, deflate, br"), "by brotli");
  EXPECT_EQ(body_for("gzip;q=1.0, br;q=0"), "by gzip");
  EXPECT_EQ(body_for("br;q=0.5"), "by brotli");
  EXPECT_EQ(body_for("brotli, gz"), "program");
  EXPECT_EQ(body_for(""), "program");
}
TEST_F(InstalledFilesTest, AreNotSentAgainToThoseWhoHaveThem) {
  const InstalledFiles files(kGuide, folder_.path());
  http::Request request = get("/guide/guide.css");
  const auto fields = files.answer(request)->fields;
  const auto tag = std::ranges::find(fields, "ETag", &std::pair<std::string, std::string>::first);
  ASSERT_NE(tag, fields.end());
  request.if_none_match = tag->second;
  EXPECT_EQ(files.answer(request)->status, 304U);
  EXPECT_EQ(files.answer(request)->body, "");
}

}  // namespace
}  // namespace yuragi::daemon::web
