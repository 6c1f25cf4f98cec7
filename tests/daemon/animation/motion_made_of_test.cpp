#include "daemon/animation/motion_made_of.hpp"

#include <string>

#include <gtest/gtest.h>

namespace yuragi::daemon::animation {
namespace {

constexpr const char* kWall = R"(
[[sensor]]
name = "roof"
driver = "nmea"
transport = "tcp"
host = "192.0.2.1"
port = 4800
[[scene]]
name = "meadow"
kind = "grass"
)";

std::uint64_t made_of(const std::string& more, std::string text = kWall, const std::string& old = "",
                      const std::string& replaced = "") {
  if (!old.empty()) text.replace(text.find(old), old.size(), replaced);
  const settings::Config config = settings::parse_config(more + text, "wall.toml");
  return motion_made_of(config, config.sensors.size());
}

TEST(MotionMadeOfTest, ItFollowsFromScenesWindAndTheNumberOfSensors) {
  const std::uint64_t wall = made_of("");
  EXPECT_NE(made_of("seed = 2\n"), wall);
  EXPECT_NE(made_of("[animation]\nrate = 50.0\n"), wall);
  EXPECT_NE(made_of("[wind]\ndefault_length = 100.0\n"), wall);
  EXPECT_NE(made_of("[shaping]\nfloor = 1.0\n"), wall);
  EXPECT_NE(made_of("[[sensor]]\nname = \"mast\"\ndriver = \"synthetic\"\n"), wall);
  EXPECT_NE(made_of("", kWall, "kind = \"grass\"", "kind = \"tree\""), wall);
  EXPECT_NE(made_of("", kWall, "kind = \"grass\"", "kind = \"grass\"\nshown = false"), wall);
  EXPECT_NE(made_of("", kWall, "port = 4800", "port = 4800\n[sensor.blend]\npriority = 2"), wall);
}

TEST(MotionMadeOfTest, ItDoesNotFollowFromDoorsAndLookOrHowASensorIsConnectedAndCalibrated) {
  const std::uint64_t wall = made_of("");
  EXPECT_EQ(made_of("[stream]\nlisten = \"0.0.0.0:7000\"\n"), wall);
  EXPECT_EQ(made_of("[http]\nlisten = \"127.0.0.1:8000\"\n"), wall);
  EXPECT_EQ(made_of("[look]\nhaze = 0.5\n"), wall);
  EXPECT_EQ(made_of("[animation]\nthreads = 4\n"), wall);
  EXPECT_EQ(made_of("[[camera]]\nname = \"near\"\n"), wall);
  EXPECT_EQ(made_of("", kWall, "192.0.2.1", "192.0.2.2"), wall);
  EXPECT_EQ(made_of("", kWall, "port = 4800", "port = 4800\n[sensor.calibration]\ngain = 1.1"), wall);
}

TEST(MotionMadeOfTest, WithoutTheLastSensorsItIsAsBeforeTheyWereAdded) {
  const std::string mast = "[[sensor]]\nname = \"mast\"\ndriver = \"synthetic\"\n";
  EXPECT_EQ(motion_made_of(settings::parse_config(kWall + mast, "wall.toml"), 1), made_of(""));
}

}  // namespace
}  // namespace yuragi::daemon::animation
