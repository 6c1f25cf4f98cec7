#include "daemon/alerts/alert_judge.hpp"

#include <chrono>
#include <utility>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace yuragi::daemon::alerts {
namespace {

using namespace std::chrono_literals;
using settings::AlertCondition;
using settings::AlertConfig;
using testing::ElementsAre;
using testing::IsEmpty;
using wind::judging::SensorState;

wire::SensorStatus sensor(std::string name, SensorState state, std::string reason = {}) {
  wire::SensorStatus status;
  status.name = std::move(name);
  status.state = state;
  status.state_reason = std::move(reason);
  return status;
}

wire::Sensors wind_of(double speed_m_s, double live_weight = 1.0) {
  wire::Sensors status;
  status.wind.wind = wind::wind_from(speed_m_s, 240.0);
  status.wind.live_weight = live_weight;
  return status;
}

wire::Sensors disk_with(double free_bytes) {
  wire::Sensors status;
  status.recorder = wire::RecorderStatus{.free_bytes = static_cast<std::uint64_t>(free_bytes)};
  return status;
}

/// Judges at moments of its own clock, and keeps what was told: "MESSAGE" where it begins, "- MESSAGE" where it ends.
class Judging {
 public:
  explicit Judging(std::vector<AlertConfig> alerts) : judge(alerts) {}

  /// For so long, twice a second.
  void hold(const wire::Sensors& status, Nanoseconds time, bool makes_frames = true) {
    for (const MonoTime end = now_.mono + time; now_.mono < end;) {
      now_.mono += 500ms;
      now_.utc += 500ms;
      if (makes_frames) ++frames_;
      for (const News& news : judge.judge(status, frames_, now_)) {
        told.push_back((news.has_begun ? "" : "- ") + news.message);
        last = news;
      }
    }
  }

  Judge judge;
  std::vector<std::string> told;
  News last;

 private:
  Instant now_{};
  std::uint64_t frames_ = 0;
};

AlertConfig silent_sensor(std::string name = {}) {
  return {.name = "silent", .sensor = std::move(name), .after_s = 60.0, .end_after_s = 60.0, .command = "page"};
}

TEST(AlertJudge, TellsASilentSensorOnceAndItsEndOnce) {
  Judging judging({silent_sensor()});
  wire::Sensors status;
  status.sensors = {sensor("roof", SensorState::kLive), sensor("yard", SensorState::kLive)};
  judging.hold(status, 10min);
  EXPECT_THAT(judging.told, IsEmpty());

  status.sensors[0] = sensor("roof", SensorState::kDisconnected, "its line is gone");
  judging.hold(status, 59s);
  EXPECT_THAT(judging.told, IsEmpty());
  judging.hold(status, 2h);
  EXPECT_THAT(judging.told, ElementsAre("sensor roof is disconnected: its line is gone (for 1 min)"));
  EXPECT_EQ(judging.last.alert, "silent");
  EXPECT_EQ(judging.last.command, "page");

  status.sensors[0] = sensor("roof", SensorState::kLive);
  judging.hold(status, 1h);
  EXPECT_THAT(judging.told, ElementsAre("sensor roof is disconnected: its line is gone (for 1 min)",
                                        "- sensor roof is live again, after 2 h"));
}

TEST(AlertJudge, GoesOnAfterARestart) {
  Judging before({silent_sensor()});
  wire::Sensors status;
  status.sensors = {sensor("roof", SensorState::kStale)};
  before.hold(status, 1h);
  const auto on = before.judge.on();
  ASSERT_THAT(on, testing::SizeIs(1));

  Judging after({silent_sensor()});
  after.judge.resume(on, {.mono = MonoTime(5min), .utc = UtcTime(2h)});
  EXPECT_EQ(after.judge.on(), on);
  after.hold(status, 10min);
  EXPECT_THAT(after.told, IsEmpty()) << "its beginning was told";
  status.sensors[0] = sensor("roof", SensorState::kLive);
  after.hold(status, 1h);
  EXPECT_THAT(after.told, ElementsAre("- sensor roof is live again, after 2 h 5 min"));
  EXPECT_THAT(after.judge.on(), IsEmpty());
}

TEST(AlertJudge, ForgetsAfterARestartWhatIsNotConfigured) {
  Judging judging({silent_sensor()});
  judging.judge.resume({{.alert = "other", .subject = "roof"},
                        {.alert = "silent", .when = AlertCondition::kNoFrame},
                        {.alert = "silent", .when = AlertCondition::kSensorSilent, .subject = {}},
                        {.alert = "silent", .subject = "gone", .begun = UtcTime(1h)}},
                       {});
  EXPECT_THAT(judging.judge.on(), testing::SizeIs(1)) << "which sensors there are is not known yet";
  wire::Sensors status;
  status.sensors = {sensor("roof", SensorState::kLive)};
  judging.hold(status, 1h);
  EXPECT_THAT(judging.told, IsEmpty());
  EXPECT_THAT(judging.judge.on(), IsEmpty());
}

TEST(AlertJudge, CutsLongSentences) {
  Judging judging({silent_sensor()});
  wire::Sensors status;
  status.sensors = {sensor("roof", SensorState::kStale, std::string(100'000, 'x'))};
  judging.hold(status, 1h);
  EXPECT_EQ(judging.last.message.size(), Judge::kMaxMessage_bytes);
}

TEST(AlertJudge, TellsEachSensorByItself) {
  Judging judging({silent_sensor()});
  wire::Sensors status;
  status.sensors = {sensor("roof", SensorState::kStale), sensor("yard", SensorState::kLive)};
  judging.hold(status, 2min);
  status.sensors[1] = sensor("yard", SensorState::kFrozen);
  judging.hold(status, 2min);
  EXPECT_THAT(judging.told, ElementsAre("sensor roof is stale (for 1 min)", "sensor yard is frozen (for 1 min)"));
}

TEST(AlertJudge, KnowsOneSensorByItsName) {
  Judging judging({silent_sensor("yard")});
  wire::Sensors status;
  status.sensors = {sensor("roof", SensorState::kStale), sensor("yard", SensorState::kLive)};
  judging.hold(status, 1h);
  EXPECT_THAT(judging.told, IsEmpty());
}

TEST(AlertJudge, AFlappingSensorIsToldOnce) {
  Judging judging({silent_sensor()});
  wire::Sensors dead;
  dead.sensors = {sensor("roof", SensorState::kStale)};
  wire::Sensors live;
  live.sensors = {sensor("roof", SensorState::kLive)};
  for (int i = 0; i < 100; ++i) {
    judging.hold(dead, 30s);
    judging.hold(live, 30s);
  }
  EXPECT_THAT(judging.told, IsEmpty()) << "it was never silent for a minute";
  judging.hold(dead, 2min);
  for (int i = 0; i < 100; ++i) {
    judging.hold(live, 30s);
    judging.hold(dead, 30s);
  }
  EXPECT_EQ(judging.told.size(), 1U) << "it was never live for a minute";
}

TEST(AlertJudge, OneGustIsEnoughAndTheEndIsTheEndOfTheStorm) {
  Judging judging(
      {{.name = "storm", .when = AlertCondition::kWindAbove, .speed_m_s = 15.0, .after_s = 0.0, .end_after_s = 600.0}});
  judging.hold(wind_of(12.0), 1h);
  for (int i = 0; i < 10; ++i) {
    judging.hold(wind_of(17.25), 1s);
    judging.hold(wind_of(12.0), 5min);
  }
  EXPECT_THAT(judging.told, ElementsAre("the wind is 17.2 m/s, above 15.0 m/s"));
  judging.hold(wind_of(12.0), 10min);
  EXPECT_THAT(judging.told, ElementsAre("the wind is 17.2 m/s, above 15.0 m/s",
                                        "- the wind is below 15.0 m/s again, after 45 min 10 s"));
}

TEST(AlertJudge, TheDefaultWindAlarmsNobodyAndEndsNothing) {
  Judging judging({{.name = "storm", .when = AlertCondition::kWindAbove, .speed_m_s = 15.0}});
  judging.hold(wind_of(20.0, 0.0), 1h);
  EXPECT_THAT(judging.told, IsEmpty());
  judging.hold(wind_of(20.0), 1s);
  judging.hold(wind_of(3.0, 0.0), 1h);
  EXPECT_THAT(judging.told, ElementsAre("the wind is 20.0 m/s, above 15.0 m/s"));
}

TEST(AlertJudge, TellsOfADiskThatIsNearlyFull) {
  Judging judging({{.name = "disk", .when = AlertCondition::kDiskBelow, .free_bytes = 500e6}});
  judging.hold({}, 1h);  // nothing is recorded
  judging.hold(disk_with(501e6), 1h);
  EXPECT_THAT(judging.told, IsEmpty());
  judging.hold(disk_with(180e6), 1h);
  judging.hold(disk_with(900e6), 1h);
  EXPECT_THAT(judging.told, ElementsAre("the disk of the recording has 180 MB free, less than 500 MB",
                                        "- the disk of the recording has 900 MB free again, after 1 h"));
}

TEST(AlertJudge, TellsThatNothingIsRecordedAndHowMuchWasLost) {
  Judging judging({{.name = "recording", .when = AlertCondition::kNotRecording, .after_s = 60.0}});
  judging.hold({}, 1h);  // nothing is to be recorded
  wire::Sensors status;
  status.recorder.emplace();
  judging.hold(status, 1h);
  EXPECT_THAT(judging.told, IsEmpty());
  status.recorder->state = wire::RecorderState::kRetrying;
  status.recorder->error = "a.windlog: the disk is full (since 2026-05-01T12:00:00Z)";
  judging.hold(status, 1h);
  status.recorder->state = wire::RecorderState::kWriting;
  status.recorder->lost = 7;
  judging.hold(status, 1h);
  EXPECT_THAT(
      judging.told,
      ElementsAre("nothing is recorded: a.windlog: the disk is full (since 2026-05-01T12:00:00Z); 0 readings lost "
                  "(for 1 min)",
                  "- readings are recorded again; 7 readings lost, after 1 h"));
}

TEST(AlertJudge, TellsThatThereAreNoFrames) {
  Judging judging({{.name = "frames", .when = AlertCondition::kNoFrame, .after_s = 10.0}});
  judging.hold({}, 1h);
  EXPECT_THAT(judging.told, IsEmpty());
  judging.hold({}, 1min, false);
  judging.hold({}, 1min);
  EXPECT_THAT(judging.told, ElementsAre("the animation makes no frames (for 10 s)",
                                        "- the animation makes frames again, after 1 min"));
}

TEST(AlertJudge, WhatHasBegunGoesOnWhenTheConfigurationIsReadAgain) {
  Judging judging({silent_sensor()});
  wire::Sensors status;
  status.sensors = {sensor("roof", SensorState::kStale)};
  judging.hold(status, 2min);
  ASSERT_EQ(judging.told.size(), 1U);

  AlertConfig changed = silent_sensor();
  changed.command = "mail";
  judging.judge.change({{.name = "other", .when = AlertCondition::kNoFrame}, changed});
  judging.hold(status, 1h);
  EXPECT_EQ(judging.told.size(), 1U) << "it has been told";
  status.sensors = {sensor("roof", SensorState::kLive)};
  judging.hold(status, 2min);
  EXPECT_THAT(judging.told, ElementsAre(testing::_, "- sensor roof is live again, after 1 h 2 min"));
  EXPECT_EQ(judging.last.command, "mail");
}

TEST(AlertJudge, ASensorThatIsGoneFromTheConfigurationIsForgotten) {
  Judging judging({silent_sensor()});
  wire::Sensors status;
  status.sensors = {sensor("roof", SensorState::kStale)};
  judging.hold(status, 2min);
  judging.hold({}, 2min);
  judging.hold(status, 2min);
  EXPECT_EQ(judging.told.size(), 2U) << "it is another one";
}

}  // namespace
}  // namespace yuragi::daemon::alerts
