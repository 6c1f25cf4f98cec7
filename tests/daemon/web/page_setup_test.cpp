#include "daemon/web/page_setup.hpp"

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/support/temporary_folder.hpp"

namespace yuragi::daemon::web {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr const char* kConfiguration =
    "[http]\ntoken_file = \"token\"\n[look]\nhaze = 0.2\n[[scene]]\nname = \"meadow\"\nkind = \"grass\"\n";

class PageSetupTest : public testing::Test {
 protected:
  PageSetupTest() { write(config_, kConfiguration); }

  static void write(const std::filesystem::path& file, const std::string& text) { std::ofstream(file) << text; }
  std::string page() const {
    std::ifstream in(page_);
    return {std::istreambuf_iterator<char>(in), {}};
  }
  settings::Config installation() const {
    return settings::with_page_values(settings::load_config(config_), page(), "page.toml");
  }
  static nlohmann::json body_of(const http::Response& response) { return nlohmann::json::parse(response.body); }
  nlohmann::json kept() const { return body_of(setup_.list_values()); }

  test::TemporaryFolder folder_;
  std::filesystem::path config_ = folder_ / "a.toml";
  std::filesystem::path page_ = folder_ / "page.toml";
  std::string asked_;
  PageSetup setup_{
      config_, page_, {.restart = [this] { asked_ += "restart;"; }, .reload = [this] { asked_ += "reload;"; }}};
};

TEST_F(PageSetupTest, KeepsValuesWithoutARestart_AndGoesBack) {
  ASSERT_EQ(setup_.keep({{"", "haze", "0.5"}}).status, 200U);
  const http::Response second = setup_.keep({{"meadow", "gain", "2"}});
  ASSERT_EQ(second.status, 200U) << second.body;
  EXPECT_EQ(body_of(second)["message"], "1 value is kept");
  EXPECT_EQ(asked_, "reload;reload;");
  EXPECT_EQ(installation().look.haze, 0.5);
  EXPECT_EQ(installation().scenes[0].wind_gain, 2.0);
  EXPECT_THAT(kept()["kept"], ElementsAre("[look] haze", "scene meadow: gain"));
  EXPECT_EQ(kept()["can_undo"], true);
  EXPECT_EQ(body_of(setup_.list())["can_undo"], false) << "no sensor was changed";
  ASSERT_EQ(setup_.undo().status, 200U);
  EXPECT_EQ(installation().scenes[0].wind_gain, 1.0);
  EXPECT_EQ(installation().look.haze, 0.5);
  ASSERT_EQ(setup_.undo().status, 200U);
  EXPECT_EQ(installation().scenes[0].wind_gain, 2.0);
  ASSERT_EQ(setup_.forget_values().status, 200U);
  EXPECT_EQ(installation().look.haze, 0.2);
  EXPECT_THAT(kept()["kept"], IsEmpty());
  EXPECT_EQ(setup_.forget_values().status, 200U) << "what is set without being kept goes back, too";
  EXPECT_EQ(asked_, "reload;reload;reload;reload;reload;reload;");
}

/// Two browsers: each change is made to the file as it is.
TEST_F(PageSetupTest, SensorsAndValuesDoNotReplaceEachOther) {
  ASSERT_EQ(setup_.add({.name = "roof", .driver = "synthetic"}).status, 200U);
  ASSERT_EQ(setup_.keep({{"", "haze", "0.5"}}).status, 200U);
  ASSERT_EQ(setup_.add({.name = "mast", .driver = "synthetic"}).status, 200U);
  EXPECT_EQ(asked_, "restart;reload;restart;");
  EXPECT_THAT(body_of(setup_.list())["sensors"], ElementsAre("roof", "mast"));
  EXPECT_EQ(kept()["can_undo"], false) << "the last change was of sensors";
  EXPECT_EQ(setup_.undo().status, 200U);
  EXPECT_EQ(asked_, "restart;reload;restart;restart;");
  EXPECT_EQ(installation().look.haze, 0.5);
  ASSERT_EQ(setup_.forget_values().status, 200U);
  EXPECT_THAT(body_of(setup_.list())["sensors"], ElementsAre("roof"));
}

TEST_F(PageSetupTest, WhatCannotBeSetWhileTheDaemonRunsIsRefused) {
  const auto refusal = [this](const settings::ParameterEdit& edit) {
    const http::Response response = setup_.keep({{"", "clouds", "0.5"}, edit});
    EXPECT_EQ(response.status, 409U);
    return response.body;
  };
  EXPECT_THAT(refusal({"", "haze", "7"}), HasSubstr("look.haze: is 7"));
  EXPECT_THAT(refusal({"", "ground_image", "/etc/passwd"}), HasSubstr("look.ground_image: is read only from"));
  EXPECT_THAT(refusal({"elm", "gain", "2"}), HasSubstr("there is no scene"));
  EXPECT_THAT(refusal({"meadow", "kind", "tree"}), HasSubstr("scene.kind"));
  EXPECT_FALSE(std::filesystem::exists(page_)) << "all or nothing";
  write(config_, "[[scene]]\nname = \"meadow\"\nkind = \"grass\"\n");
  EXPECT_THAT(refusal({"", "haze", "0.5"}), HasSubstr("token_file"));
  write(config_, "[look]\nhaze = 7\n");
  EXPECT_THAT(refusal({"", "haze", "0.5"}), HasSubstr("the configuration has mistakes"));
  EXPECT_EQ(asked_, "");
}

TEST_F(PageSetupTest, NothingIsAddedToADamagedFile) {
  write(page_, "[[");
  EXPECT_EQ(setup_.add({.name = "roof", .driver = "synthetic"}).status, 409U);
  EXPECT_EQ(setup_.keep({{"", "haze", "0.5"}}).status, 409U);
  EXPECT_EQ(page(), "[[");
  EXPECT_THAT(kept()["trouble"], "page.toml is not TOML");
}

/// A mistake of a sensor hinders no value.
TEST_F(PageSetupTest, ValuesAreKeptBesideASensorThatCannotBeUsed) {
  write(page_, "[[sensor]]\ndriver = \"nothing\"\n");
  EXPECT_EQ(setup_.keep({{"", "haze", "0.5"}}).status, 200U);
  EXPECT_EQ(setup_.add({.name = "roof", .driver = "synthetic"}).status, 409U);
}

/// What was kept of a scene that is gone hinders nobody, and is there again with the scene.
TEST_F(PageSetupTest, ValuesOfASceneThatIsGoneStay) {
  ASSERT_EQ(setup_.keep({{"meadow", "gain", "2"}}).status, 200U);
  write(config_, "[http]\ntoken_file = \"token\"\n");
  ASSERT_EQ(setup_.keep({{"", "haze", "0.5"}}).status, 200U);
  ASSERT_EQ(setup_.add({.name = "roof", .driver = "synthetic"}).status, 200U);
  write(config_, kConfiguration);
  EXPECT_EQ(installation().scenes[0].wind_gain, 2.0);
}

TEST_F(PageSetupTest, AFailureToWriteLeavesTheOldFile) {
  ASSERT_EQ(setup_.keep({{"", "haze", "0.5"}}).status, 200U);
  const std::string old = page();
  std::filesystem::remove(page_.string() + ".before");
  std::filesystem::create_directories(page_.string() + ".before/full");
  const http::Response response = setup_.keep({{"", "haze", "0.6"}});
  EXPECT_EQ(response.status, 409U);
  EXPECT_THAT(response.body, HasSubstr("page.toml.before"));
  EXPECT_EQ(page(), old);
  EXPECT_EQ(asked_, "reload;");
}

}  // namespace
}  // namespace yuragi::daemon::web
