#include "daemon/web/site.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <future>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include "tests/support/temporary_folder.hpp"

namespace yuragi::daemon::web {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::Not;

class SiteTest : public testing::Test {
 protected:
  SiteTest() {
    fs::create_directories(folder_ / "art" / ".git");
    write(outside_.path() / "secret.txt", "secret");
    write(folder_ / "index.html", "<p>home");
    write(folder_ / "art" / "index.html", "<p>art");
    write(folder_ / "art" / "sketch 1.js", "draw()");
    write(folder_ / "art" / ".git" / "config", "secret");
    write(folder_ / ".htpasswd", "secret");
  }
  static void write(const fs::path& file, const std::string& text) { std::ofstream(file) << text; }
  http::Response get(const std::string& path, const std::string& entity_tag = "") const {
    return site_response(folder_, {.method = "GET", .path = path, .if_none_match = entity_tag});
  }
  static std::string field(const http::Response& response, const std::string& name) {
    const auto found = std::ranges::find(response.fields, name, &std::pair<std::string, std::string>::first);
    return found == response.fields.end() ? "" : found->second;
  }

  test::TemporaryFolder inside_, outside_;
  fs::path folder_ = inside_.path() / "www";
};

TEST_F(SiteTest, FilesWithTheirTypes) {
  EXPECT_EQ(get("/site/").body, "<p>home");
  EXPECT_EQ(get("/site/").content_type, "text/html; charset=utf-8");
  const http::Response script = get("/site/art/sketch%201.js");
  EXPECT_EQ(script.status, 200U);
  EXPECT_EQ(script.body, "draw()");
  EXPECT_EQ(script.content_type, "text/javascript; charset=utf-8");
  EXPECT_THAT(field(script, "Content-Security-Policy"), HasSubstr("script-src 'self'"));
  write(folder_ / "a.UNKNOWN", "a");
  EXPECT_EQ(get("/site/a.UNKNOWN").content_type, "application/octet-stream");
  write(folder_ / "a.PNG", "a");
  EXPECT_EQ(get("/site/a.PNG").content_type, "image/png");
}
TEST_F(SiteTest, AFolderIsItsIndex) {
  EXPECT_EQ(get("/site/art/").body, "<p>art");
  EXPECT_EQ(field(get("/site/art"), "Location"), "/site/art/");
  EXPECT_EQ(field(get("/site"), "Location"), "/site/");
  fs::create_directory(folder_ / "empty");
  EXPECT_EQ(get("/site/empty/").status, 404U);
}
TEST_F(SiteTest, IsReadAgainAtEachRequest) {
  const std::string entity_tag = field(get("/site/"), "ETag");
  EXPECT_EQ(get("/site/", entity_tag).status, 304U);
  EXPECT_EQ(get("/site/", entity_tag).body, "");
  write(folder_ / "index.html", "<p>changed");
  EXPECT_EQ(get("/site/", entity_tag).body, "<p>changed");
}
TEST_F(SiteTest, NothingOutsideAndNothingHidden) {
  const std::string outside = outside_.path().filename().string();
  fs::create_symlink(outside_.path() / "secret.txt", folder_ / "link.txt");
  fs::create_directory_symlink(outside_.path(), folder_ / "linked");
  fs::create_directory(folder_ / "sub");
  fs::create_symlink(outside_.path() / "secret.txt", folder_ / "sub" / "index.html");
  fs::create_directory(inside_.path() / "www2");
  write(inside_.path() / "www2" / "secret.txt", "secret");
  for (const std::string& path : {std::string("/site/../") + outside + "/secret.txt",
                                  std::string("/site/%2e%2e/") + outside + "/secret.txt",
                                  std::string("/site/art/../../../") + outside + "/secret.txt",
                                  std::string("/site/..%2f") + outside,
                                  "/site/" + outside_.path().string() + "/secret.txt",
                                  "/site/%2f" + outside_.path().string() + "/secret.txt",
                                  std::string("/site/link.txt"),
                                  std::string("/site/linked/secret.txt"),
                                  std::string("/site/sub/"),
                                  std::string("/site/../www2/secret.txt"),
                                  std::string("/site/.htpasswd"),
                                  std::string("/site/%2ehtpasswd"),
                                  std::string("/site/art/.git/config"),
                                  std::string("/site/art/index.html%00.txt"),
                                  std::string("/site/%"),
                                  std::string("/site/%g1"),
                                  std::string("/site/%+1"),
                                  std::string("/site/\xff"),
                                  std::string("/site/nowhere"),
                                  "/site/" + std::string(5000, 'a')}) {
    EXPECT_EQ(get(path).status, 404U) << path;
    EXPECT_THAT(get(path).body, Not(HasSubstr("\"secret\""))) << path;
  }
}
TEST_F(SiteTest, ALinkThatStaysWithinIsFollowed) {
  fs::create_symlink("art/index.html", folder_ / "link.html");
  EXPECT_EQ(get("/site/link.html").body, "<p>art");
}
TEST_F(SiteTest, WhatIsNoFileOrTooLargeIsRefused) {
  ASSERT_EQ(mkfifo((folder_ / "pipe").c_str(), 0600), 0);
  EXPECT_EQ(get("/site/pipe").status, 404U);
  std::ofstream(folder_ / "large.bin").close();
  fs::resize_file(folder_ / "large.bin", kMaxSiteFile_bytes + 1);
  EXPECT_EQ(get("/site/large.bin").status, 404U);
  EXPECT_THAT(get("/site/large.bin").body, HasSubstr("too large"));
  fs::remove_all(folder_);
  EXPECT_THAT(get("/site/").body, HasSubstr("[http] folder cannot be read"));
}

TEST_F(SiteTest, AnswersOnItsThread_OrThatThereIsNone) {
  const auto answer = [](Site& site) {
    std::promise<http::Response> given;
    site.answer({.method = "GET", .path = "/site/"}, [&](http::Response response) { given.set_value(response); });
    return given.get_future().get();
  };
  Site site(folder_);
  EXPECT_EQ(answer(site).body, "<p>home");
  Site none({});
  EXPECT_THAT(answer(none).body, HasSubstr("set [http] folder"));
}

}  // namespace
}  // namespace yuragi::daemon::web
