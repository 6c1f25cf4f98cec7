#include <filesystem>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <gtest/gtest.h>

#include "drivers/windlog/windlog_playback.hpp"
#include "engine/wind/turbulence/synthetic_wind.hpp"
#include "simulators/core/command.hpp"
#include "tests/support/temporary_folder.hpp"

namespace yuragi::simulators::core {

extern const Command kRecordingCommand;

namespace {

class RecordingCommand : public testing::Test {
 protected:
  /// `yuragi-sim recording -o FILE ARGUMENTS`.
  static void record(const std::filesystem::path& file, const std::string& arguments) {
    CLI::App app;
    kRecordingCommand.add(app);
    app.parse("recording -o " + file.string() + " " + arguments);
  }

  static std::vector<drivers::windlog::PlayedReading> readings_of(const std::filesystem::path& file,
                                                                  const std::string& sensor = "*") {
    drivers::windlog::Playback playback = drivers::windlog::Playback::open(file, {.sensor = sensor}).value();
    std::vector<drivers::windlog::PlayedReading> readings;
    while (const auto reading = playback.next().value()) readings.push_back(*reading);
    return readings;
  }

  test::TemporaryFolder folder_;
};

TEST_F(RecordingCommand, HoldsTheModelsWindReadingByReading) {
  record(folder_ / "storm.windlog",
         "--speed 17 --direction 280 --turbulence 0.3 --seed 2 --duration 60 --interval 0.5");
  const auto readings = readings_of(folder_ / "storm.windlog");
  ASSERT_EQ(readings.size(), 120U);
  const wind::turbulence::SyntheticWind wind(
      {.mean_speed_m_s = 17.0, .mean_direction_deg = 280.0, .turbulence_intensity = 0.3, .seed = 2});
  for (std::size_t i = 0; i < readings.size(); ++i) {
    const double time_s = 0.5 * static_cast<double>(i);
    EXPECT_DOUBLE_EQ(readings[i].log_time_s, time_s);
    EXPECT_DOUBLE_EQ(readings[i].reading.speed_m_s, speed_of(wind.at(time_s)));
    EXPECT_DOUBLE_EQ(*readings[i].reading.direction_deg, wind::direction_from_deg(wind.at(time_s)));
    EXPECT_EQ(readings[i].reading.quality, wind::ReadingQuality::kSimulated);
  }
}

TEST_F(RecordingCommand, IsAnHourOfOneHertzUnlessToldOtherwise) {
  record(folder_ / "hour.windlog", "");
  EXPECT_EQ(readings_of(folder_ / "hour.windlog").size(), 3600U);
}

TEST_F(RecordingCommand, HasSeveralSensorsInOneWind) {
  record(folder_ / "both.windlog", "--sensor roof:0.5 --sensor mast --duration 10");
  const auto roof = readings_of(folder_ / "both.windlog", "roof");
  const auto mast = readings_of(folder_ / "both.windlog", "mast");
  ASSERT_EQ(roof.size(), 10U);
  ASSERT_EQ(mast.size(), 10U);
  for (std::size_t i = 0; i < 10; ++i) {
    EXPECT_DOUBLE_EQ(roof[i].reading.speed_m_s, 0.5 * mast[i].reading.speed_m_s);
    EXPECT_EQ(roof[i].reading.direction_deg, mast[i].reading.direction_deg);
  }
}

TEST_F(RecordingCommand, CanHaveFaults) {
  record(folder_ / "ill.windlog", "--duration 30 --fault silence@5+5 --fault freeze@15+5 --fault spike@25+1");
  const auto readings = readings_of(folder_ / "ill.windlog");
  ASSERT_EQ(readings.size(), 25U);
  EXPECT_DOUBLE_EQ(readings[5].log_time_s, 10.0);
  for (std::size_t i = 11; i < 15; ++i) EXPECT_EQ(readings[i].reading.speed_m_s, readings[10].reading.speed_m_s);
  EXPECT_GT(readings[20].reading.speed_m_s, 50.0);
}

TEST_F(RecordingCommand, OverwritesOnlyWhenToldTo) {
  const auto file = folder_ / "day.windlog";
  record(file, "--duration 3");
  EXPECT_THROW(record(file, "--duration 5"), CLI::ValidationError);
  EXPECT_EQ(readings_of(file).size(), 3U);
  record(file, "--duration 5 --force");
  EXPECT_EQ(readings_of(file).size(), 5U);
}

TEST_F(RecordingCommand, LeavesNothingWhereItFails) {
  const auto file = folder_ / "none.windlog";
  for (const char* wrong : {"--sensor roof:many", "--sensor :2", "--sensor roof:-1", "--fault unplug@1+2"}) {
    EXPECT_THROW(record(file, wrong), CLI::ValidationError) << wrong;
    EXPECT_TRUE(std::filesystem::is_empty(folder_.path())) << wrong;
  }
  EXPECT_THROW(record(folder_ / "no/such/folder.windlog", ""), std::runtime_error);
}

}  // namespace
}  // namespace yuragi::simulators::core
