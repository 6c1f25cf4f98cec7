#include "daemon/web/guide.hpp"

#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/temporary_folder.hpp"

namespace yuragi::daemon::web {
namespace {

using testing::HasSubstr;

class GuideTest : public testing::Test {
 protected:
  GuideTest() {
    for (const auto& [name, text] : {std::pair("index.html", "<p>all pages"), std::pair("sensors.html", "<p>sensors"),
                                     std::pair("guide.css", "a {}"), std::pair("secret.txt", "secret")}) {
      std::ofstream(folder_ / name) << text;
    }
  }
  static http::Request get(const std::string& path) { return {.method = "GET", .path = path}; }

  const test::TemporaryFolder folder_;
};

TEST_F(GuideTest, HasThePagesOfItsFolder) {
  const Guide guide(folder_.path());
  EXPECT_EQ(guide.answer(get("/guide/"))->body, "<p>all pages");
  EXPECT_EQ(guide.answer(get("/guide/sensors.html"))->body, "<p>sensors");
  EXPECT_EQ(guide.answer(get("/guide/sensors.html"))->content_type, "text/html; charset=utf-8");
  EXPECT_EQ(guide.answer(get("/guide/guide.css"))->content_type, "text/css; charset=utf-8");
}
TEST_F(GuideTest, ServesNoOtherFile) {
  const Guide guide(folder_.path());
  for (const char* path : {"/guide/secret.txt", "/guide/../secret.txt", "/guide//etc/passwd", "/guide/nothing.html"}) {
    EXPECT_EQ(guide.answer(get(path))->status, 404U) << path;
  }
  EXPECT_THAT(guide.answer(get("/guide/nothing.html"))->body, HasSubstr("nothing.html"));
}
TEST_F(GuideTest, LeavesOtherRequestsToOthers) {
  const Guide guide(folder_.path());
  EXPECT_FALSE(guide.answer(get("/guide")));
  EXPECT_FALSE(guide.answer(get("/healthz")));
  EXPECT_FALSE(guide.answer({.method = "POST", .path = "/guide/"}));
}
TEST_F(GuideTest, GivesTheReasonIfItIsNotInstalled) {
  for (const Guide& guide : {Guide(), Guide(folder_ / "missing")}) {
    const auto response = guide.answer(get("/guide/"));
    EXPECT_EQ(response->status, 404U);
    EXPECT_THAT(response->body, HasSubstr("not installed"));
  }
}

}  // namespace
}  // namespace yuragi::daemon::web
