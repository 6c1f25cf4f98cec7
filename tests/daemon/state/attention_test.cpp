#include "daemon/state/attention.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace yuragi::daemon::state {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using wind::judging::SensorState;

/// A daemon for which all is well.
wire::Sensors well() {
  wire::SensorStatus sensor;
  sensor.name = "roof";
  sensor.state = SensorState::kLive;
  sensor.state_reason = "a reading every 0.5 s";
  wire::Sensors sensors;
  sensors.sensors = {sensor};
  sensors.io_lateness = wire::Lateness{.p50_s = 0.0001, .p99_s = 0.001, .max_s = 2.0};
  sensors.recent_ticks = 36'000;
  sensors.recent_skipped_ticks = 359;
  sensors.recorder = wire::RecorderStatus{.written = 1000, .waiting = 3, .free_bytes = 5'000'000'000};
  sensors.refused_clients = 4;
  sensors.late_ticks = 1'000'000;
  return sensors;
}

TEST(Attention, IsNotNeededWhereAllIsWell) {
  EXPECT_THAT(needs_attention(well()), IsEmpty());
  EXPECT_THAT(needs_attention(wire::Sensors{}), IsEmpty()) << "what is not known is no trouble";
}

TEST(Attention, IsNeededByASensorWhoseReadingsAreNotUsed) {
  for (std::size_t i = 0; i < wind::judging::kSensorStateNames.size(); ++i) {
    wire::Sensors sensors = well();
    wire::SensorStatus& sensor = sensors.sensors.front();
    sensor.state = static_cast<SensorState>(i);
    sensor.state_reason = "the reason";
    if (is_believed(sensor.state)) {
      EXPECT_THAT(needs_attention(sensors), IsEmpty()) << name_of(sensor.state);
    } else {
      EXPECT_THAT(needs_attention(sensors),
                  ElementsAre("sensor roof is " + std::string(name_of(sensor.state)) + ": the reason"));
    }
  }
}

TEST(Attention, TellsWhatHappenedToTheLinkWhereNoReasonIsKnown) {
  wire::Sensors sensors = well();
  sensors.sensors.front().state = SensorState::kConnecting;
  sensors.sensors.front().state_reason.clear();
  sensors.sensors.front().detail = "/dev/ttyUSB0: No such file or directory";
  EXPECT_THAT(needs_attention(sensors),
              ElementsAre("sensor roof is connecting: /dev/ttyUSB0: No such file or directory"));
}

TEST(Attention, IsNeededByASensorWhoseVaneIsSilent) {
  wire::Sensors sensors = well();
  sensors.sensors[0].quantities = {{.quantity = wind::judging::Quantity::kDirection, .age_s = 1.0}};
  EXPECT_THAT(needs_attention(sensors), IsEmpty());
  sensors.sensors[0].quantities[0] = {.is_missing = true, .reason = "none for 3 min; the last one is kept"};
  EXPECT_THAT(needs_attention(sensors),
              ElementsAre("sensor roof sends no direction: none for 3 min; the last one is kept"));
  sensors.sensors[0].state = SensorState::kStale;
  EXPECT_THAT(needs_attention(sensors), ElementsAre(HasSubstr("sensor roof is stale"))) << "one trouble at a time";
}

TEST(Attention, IsNeededByARecorderThatCannotWrite) {
  wire::Sensors sensors = well();
  sensors.recorder->state = wire::RecorderState::kRetrying;
  sensors.recorder->error = "No space left on device";
  EXPECT_THAT(needs_attention(sensors),
              ElementsAre(AllOf(HasSubstr("cannot write"), HasSubstr("No space left on device"))));
  sensors.recorder->state = wire::RecorderState::kHanging;
  EXPECT_THAT(needs_attention(sensors), ElementsAre(HasSubstr("does not respond")));
}

TEST(Attention, IsNeededByAClockThatIsDoubted) {
  wire::Sensors sensors = well();
  sensors.recorder->clock_doubt = "the clock may be wrong since today";
  EXPECT_THAT(needs_attention(sensors), ElementsAre("the clock may be wrong since today"));
}

TEST(Attention, IsNeededByReadingsThatWereLost) {
  wire::Sensors sensors = well();
  sensors.recorder->lost = 1;
  EXPECT_THAT(needs_attention(sensors), ElementsAre(HasSubstr("dropped 1 reading since")));
}

TEST(Attention, IsNeededByADiskThatIsNearlyFull) {
  wire::Sensors sensors = well();
  sensors.recorder->free_bytes = 200'000'000;
  EXPECT_THAT(needs_attention(sensors), IsEmpty());
  sensors.recorder->free_bytes = 199'000'000;
  EXPECT_THAT(needs_attention(sensors), ElementsAre(HasSubstr("nearly full: 199 MB free")));
}

TEST(Attention, IsNeededByAnAnimationThatStutters) {
  wire::Sensors sensors = well();
  sensors.recent_skipped_ticks = 360;
  EXPECT_THAT(needs_attention(sensors),
              ElementsAre(HasSubstr("1.0 % of the ticks of the last 10 minutes were skipped")));
  sensors.recent_ticks = 1370;
  sensors.recent_skipped_ticks = 565;
  EXPECT_THAT(needs_attention(sensors), ElementsAre(HasSubstr("skipped (565 of 1370)")));
  sensors.recent_ticks = 599;
  EXPECT_THAT(needs_attention(sensors), IsEmpty()) << "its first seconds";
}

TEST(Attention, IsNeededByLatenessThatIsNotRare) {
  wire::Sensors sensors = well();
  sensors.io_lateness->p99_s = 0.120;
  EXPECT_THAT(needs_attention(sensors), ElementsAre(HasSubstr("more than 120 ms")));
}

TEST(Attention, NamesEachThingByItself) {
  wire::Sensors sensors = well();
  sensors.sensors.front().state = SensorState::kStale;
  sensors.sensors.push_back(sensors.sensors.front());
  sensors.recorder->lost = 2;
  sensors.recorder->free_bytes = 0;
  EXPECT_EQ(needs_attention(sensors).size(), 4U);
}

TEST(Attention, IsNeededByAClockThatPutsScreensOutOfStep) {
  EXPECT_EQ(clock_trouble({.offset_s = 0.0049, .source = "chrony"}), "");
  EXPECT_EQ(clock_trouble({.offset_s = std::nullopt, .source = "no time service replies"}), "");
  EXPECT_THAT(clock_trouble({.offset_s = -0.0051, .source = "chrony"}),
              AllOf(HasSubstr("5.10 ms behind UTC (chrony)"), HasSubstr("chronyc sources")));
  EXPECT_EQ(clock_trouble_of_viewer("192.0.2.7:40116", -0.0049), "");
  EXPECT_THAT(clock_trouble_of_viewer("192.0.2.7:40116", 0.012),
              AllOf(HasSubstr("12 ms ahead of UTC (the viewer at 192.0.2.7:40116)"), HasSubstr("on its machine")));
}

}  // namespace
}  // namespace yuragi::daemon::state
