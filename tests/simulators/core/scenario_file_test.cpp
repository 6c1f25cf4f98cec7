#include "simulators/core/scenario_file.hpp"

#include <fstream>
#include <stdexcept>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/temporary_folder.hpp"

namespace yuragi::simulators::core {
namespace {

using testing::ElementsAre;
using testing::StartsWith;

constexpr const char* kDevice = "[[device]]\nname = \"a\"\nsimulate = \"nmea --pty\"\n";

class ScenarioFile : public testing::Test {
 protected:
  Scenario read(const std::string& text) {
    std::ofstream(file_) << text;
    return read_scenario(file_);
  }

  /// What is said of it, behind the name of the file.
  std::string complaint_about(const std::string& text) {
    try {
      read(text);
    } catch (const std::runtime_error& error) {
      const std::string what = error.what();
      return what.starts_with(file_.string()) ? what.substr(file_.string().size()) : what;
    }
    return "nothing";
  }

  test::TemporaryFolder folder_;
  std::filesystem::path file_ = folder_ / "day.toml";
};

TEST_F(ScenarioFile, SaysWhatBlowsWhenWhichDevicesThereAreAndWhatGoesWrong) {
  const Scenario scenario = read(R"(
duration = "2h"
[[wind]]
speed = 1
[[wind]]
at = "5min"
ramp = "20s"
recording = "storm.windlog"
[[device]]
name = "roof"
simulate = "modbus --tcp 127.0.0.1:1502"
faults = ["silence@6min+20s", "freeze@8min+5"]
)");
  EXPECT_EQ(scenario.duration_s, 7200.0);
  ASSERT_EQ(scenario.phases.size(), 2U);
  EXPECT_EQ(scenario.phases[0].synthetic.mean_speed_m_s, 1.0);
  EXPECT_EQ(scenario.phases[1].start_s, 300.0);
  EXPECT_EQ(scenario.phases[1].ramp_s, 20.0);
  EXPECT_EQ(scenario.phases[1].recording, (folder_ / "storm.windlog").string());
  ASSERT_EQ(scenario.devices.size(), 1U);
  EXPECT_EQ(scenario.devices[0].name, "roof");
  EXPECT_EQ(scenario.devices[0].simulate, "modbus --tcp 127.0.0.1:1502");
  EXPECT_THAT(scenario.devices[0].faults, ElementsAre("silence@6min+20s", "freeze@8min+5"));
}

TEST_F(ScenarioFile, TellsEachMistakeWithItsPlace) {
  const std::string device = kDevice;
  EXPECT_THAT(complaint_about("speed ="), StartsWith(":1:"));
  EXPECT_THAT(complaint_about(device), StartsWith(":1:1: wind: at least one [[wind]] is needed"));
  EXPECT_THAT(complaint_about("[[wind]]\n"), StartsWith(":1:1: device: at least one [[device]] is needed"));
  EXPECT_THAT(complaint_about("[[wind]]\nspeed = 61\n" + device),
              StartsWith(":2:9: wind.speed: must be a number from 0 to 60"));
  EXPECT_THAT(complaint_about("[[wind]]\nspeed = nan\n" + device), StartsWith(":2:9: wind.speed: must be a number"));
  EXPECT_THAT(complaint_about("[[wind]]\nat = 5\n" + device), StartsWith(":2:6: wind.at: the first wind"));
  EXPECT_THAT(complaint_about("[[wind]]\nat = \"soon\"\n" + device), StartsWith(":2:6: wind.at: "));
  EXPECT_THAT(complaint_about("[[wind]]\nat = true\n" + device), StartsWith(":2:6: wind.at: "));
  EXPECT_THAT(complaint_about("[[wind]]\n[[wind]]\nat = 5\nramp = 9\n[[wind]]\nat = 13\n" + device),
              StartsWith(":6:6: wind.at: must be after"));
  EXPECT_THAT(complaint_about("[[wind]]\nrecording = \"a\"\nspeed = 2\n" + device),
              StartsWith(":3:9: wind.speed: is not known here; allowed: at, ramp, recording"));
  EXPECT_THAT(complaint_about("[[wind]]\n[[device]]\nname = \"a\"\n"), StartsWith(":2:1: device.simulate: must be"));
  EXPECT_THAT(complaint_about("[[wind]]\n" + device + "faults = \"silence@1+1\"\n"),
              StartsWith(":5:10: device.faults: must be a list"));
  EXPECT_THAT(complaint_about("[[wind]]\n" + device + device), StartsWith(":6:8: device.name: another device"));
  EXPECT_THAT(complaint_about("pace = 2\n[[wind]]\n" + device), StartsWith(":1:8: pace: is not known here"));
}

TEST_F(ScenarioFile, ThatIsNotThereIsSaidToBe) {
  EXPECT_THROW(read_scenario(folder_ / "none.toml"), std::runtime_error);
}

}  // namespace
}  // namespace yuragi::simulators::core
