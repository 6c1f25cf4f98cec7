#include "daemon/settings/config_file.hpp"

#include <filesystem>
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "daemon/settings/config.hpp"
#include "tests/support/temporary_folder.hpp"

namespace yuragi::daemon::settings {
namespace {

using ::testing::HasSubstr;
namespace fs = std::filesystem;

constexpr std::string_view kOldWall = "# mine\n[[sensor]]\ndriver = \"synthetic\"\nspeed = 3\n";
constexpr std::string_view kNewWall = "# mine\n[[sensor]]\ndriver = \"synthetic\"\nspeed = 4\n";

class ConfigFile : public testing::Test {
 protected:
  ConfigFile() : wall_(folder_ / "wall.toml") { write(wall_, kOldWall); }

  static void write(const fs::path& file, std::string_view text) { std::ofstream(file, std::ios::binary) << text; }

  /// What is said of a text that is not taken; the file and its folder must be as they were.
  std::string refusal(std::string_view old_text, std::string_view new_text) {
    const std::string before = read_config_text(wall_);
    const auto replaced = replace_config(wall_, old_text, new_text);
    if (replaced) return "it was taken";
    EXPECT_EQ(read_config_text(wall_), before);
    EXPECT_EQ(std::distance(fs::directory_iterator(folder_.path()), {}), 1) << "nothing is left beside it";
    return replaced.error().message;
  }

  test::TemporaryFolder folder_;
  fs::path wall_;
};

TEST_F(ConfigFile, IsReplacedAsAWholeAndItsOldTextKept) {
  fs::permissions(wall_, fs::perms::owner_read | fs::perms::owner_write);
  EXPECT_EQ(replace_config(wall_, kOldWall, kNewWall).value().filename(), "wall.toml.bak");
  EXPECT_EQ(read_config_text(wall_), kNewWall);
  EXPECT_EQ(read_config_text(folder_ / "wall.toml.bak"), kOldWall);
  for (const char* name : {"wall.toml", "wall.toml.bak"}) {
    EXPECT_EQ(fs::status(folder_ / name).permissions(), fs::perms::owner_read | fs::perms::owner_write) << name;
  }
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_.path()), {}), 2);
}

TEST_F(ConfigFile, BehindALinkIsReplacedAndTheLinkStays) {
  const fs::path link = folder_ / "current.toml";
  fs::create_symlink("wall.toml", link);
  replace_config(link, kOldWall, kNewWall).value();
  EXPECT_TRUE(fs::is_symlink(link));
  EXPECT_EQ(read_config_text(wall_), kNewWall);
}

TEST_F(ConfigFile, StaysWhereTheNewTextWouldBeWrong) {
  EXPECT_THAT(refusal(kOldWall, "[[sensor]]\ndriver = \"synthetic\"\nspeed = -1\n"), HasSubstr("speed: is -1"));
  EXPECT_THAT(refusal(kOldWall, "[[sensor\n"), HasSubstr("TOML"));
  const std::string microphone = "[[sensor]]\ndriver = \"microphone\"\n";
  write(wall_, microphone);
  EXPECT_THAT(refusal(microphone, microphone + "curve = \"5\"\n"), HasSubstr("curve")) << "what only the driver knows";
}

TEST_F(ConfigFile, ASensorThatCouldNotBeOpenedBeforeStandsInNobodysWay) {
  const std::string elsewhere = "[[sensor]]\ndriver = \"modbus\"\nprofile = \"no-such-device\"\n";
  write(wall_, elsewhere);
  replace_config(wall_, elsewhere, elsewhere + "[sensor.calibration]\ngain = 2.0\n").value();
  EXPECT_THAT(read_config_text(wall_), HasSubstr("gain = 2.0"));
}

TEST_F(ConfigFile, StaysWhereSomebodyHasChangedItMeanwhile) {
  write(wall_, "# somebody else's\n");
  EXPECT_THAT(refusal(kOldWall, kNewWall), HasSubstr("was changed by another program"));
}

TEST_F(ConfigFile, ThatIsNotThereIsTold) {
  EXPECT_EQ(replace_config(folder_ / "none.toml", "", kNewWall).error().kind, FailureKind::kCannotCreate);
}

TEST(StateFile, IsWhereSystemdOrTheConfigurationIs) {
  unsetenv("STATE_DIRECTORY");  // NOLINT(concurrency-mt-unsafe): no other thread
  EXPECT_EQ(state_file({}, "alerts.json"), "");
  EXPECT_EQ(state_file("/home/a/wall.toml", "alerts.json"), "/home/a/wall.toml.alerts.json");
  setenv("STATE_DIRECTORY", "/var/lib/yuragi:/b", 1);  // NOLINT(concurrency-mt-unsafe)
  EXPECT_EQ(state_file("/home/a/wall.toml", "alerts.json"), "/var/lib/yuragi/alerts.json");
  unsetenv("STATE_DIRECTORY");  // NOLINT(concurrency-mt-unsafe)
}

}  // namespace
}  // namespace yuragi::daemon::settings
