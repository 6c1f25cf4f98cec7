// The hub with its judges: what the sensors say, good and bad, and the wind and the states that come of it.
#include <cmath>
#include <deque>
#include <future>
#include <limits>
#include <memory>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <spdlog/sinks/ostream_sink.h>
#include <spdlog/spdlog.h>

#include "daemon/sensing/sensor_hub.hpp"
#include "engine/wind/turbulence/synthetic_wind.hpp"
#include "tests/support/manual_clock.hpp"

namespace yuragi::daemon::sensing {
namespace {

using ::testing::HasSubstr;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// What a sensor's thread hands to the test, which speaks in its place while the thread waits.
struct SensorControl {
  std::promise<drivers::sensor::Sink*> sink;
  std::promise<void> end;
};
std::deque<SensorControl>* controls = nullptr;
std::size_t controls_given = 0;

class ControlledSensor final : public drivers::sensor::Sensor {
 public:
  ControlledSensor() : control_(controls->at(controls_given++)) {}
  MonoTime poll(const drivers::sensor::Clock&, drivers::sensor::Sink& sink) override {
    control_.sink.set_value(&sink);
    control_.end.get_future().wait();
    return MonoTime::max();
  }
  void interrupt() noexcept override { control_.end.set_value(); }

 private:
  SensorControl& control_;
};

std::unique_ptr<drivers::sensor::Sensor> open_controlled(const ParameterValues&) {
  return std::make_unique<ControlledSensor>();
}
const drivers::sensor::DriverDescription kControlledDriver{
    .name = "spoken", .summary = "", .parameters = {}, .open = open_controlled};
const drivers::sensor::DriverDescription kPlayedDriver{
    .name = "played", .summary = "", .parameters = {}, .open = open_controlled, .plays_recordings = true};

class SensorJudgement : public ::testing::Test {
 protected:
  explicit SensorJudgement(std::size_t sensor_count = 1) {
    config_ = settings::default_config();
    config_.wind.default_speed_m_s = 2.0;
    config_.sensors.clear();
    for (std::size_t i = 0; i < sensor_count; ++i) add_sensor(kControlledDriver);
    auto logger = std::make_shared<spdlog::logger>("test", std::make_shared<spdlog::sinks::ostream_sink_mt>(log_));
    logger->set_pattern("%l %v");
    usual_logger_ = spdlog::default_logger();
    spdlog::set_default_logger(std::move(logger));
  }
  ~SensorJudgement() override { spdlog::set_default_logger(usual_logger_); }
  SensorJudgement(const SensorJudgement&) = delete;
  SensorJudgement& operator=(const SensorJudgement&) = delete;

  void add_sensor(const drivers::sensor::DriverDescription& driver) {
    const std::string name = std::string(driver.name) + std::to_string(config_.sensors.size());
    config_.sensors.push_back(settings::default_sensor(name, driver, {}, "wall.toml:3:1"));
  }

  void start() {
    static const auto noise = make_gust_noise(settings::default_config());
    controls_.resize(config_.sensors.size());
    controls = &controls_;
    controls_given = 0;
    hub_ =
        std::make_unique<SensorHub>(config_, clock_, noise, [this](std::size_t, const wind::Reading&) { ++recorded_; });
    for (SensorControl& control : controls_) {
      sinks_.push_back(control.sink.get_future().get());
      sinks_.back()->link(wind::LinkState::kConnected, "here");
    }
  }

  void publish(std::size_t sensor, double speed_m_s, double direction_deg = 250.0, double late_s = 0.0) {
    wind::Reading reading;
    reading.time = clock_.now();
    reading.time.mono -= from_seconds(late_s);
    reading.speed_m_s = speed_m_s;
    reading.direction_deg = direction_deg;
    reading.quality = quality_;
    sinks_[sensor]->reading(reading);
  }
  /// A turbulent wind around a mean, never twice the same.
  double breeze(double mean_m_s = 6.0) const {
    const double time_s = seconds(clock_.now().mono.time_since_epoch());
    return mean_m_s * (1.0 + 0.12 * std::sin(1.7 * time_s) + 0.05 * std::sin(5.1 * time_s));
  }
  /// Time goes on; `each` is told of every second.
  template <class Each>
  void go_on(double duration_s, Each each) {
    const auto ticks = static_cast<int>(duration_s * kTicksPerSecond);
    for (int tick = 0; tick < ticks; ++tick) {
      clock_.advance(from_seconds(1.0 / kTicksPerSecond));
      if (tick % kTicksPerSecond == 0) each();
      const wind::Vector before = hub_->wind().wind;
      const wind::State& state = hub_->advance();
      ASSERT_TRUE(std::isfinite(state.wind.u_m_s) && std::isfinite(state.wind.v_m_s));
      largest_wind_m_s_ = std::max(largest_wind_m_s_, speed_of(state.wind));
      largest_step_m_s_ = std::max(largest_step_m_s_, speed_of(state.wind - before));
    }
  }
  wind::judging::SensorState state(std::size_t sensor = 0) const { return hub_->status().at(sensor).state; }
  std::string reason(std::size_t sensor = 0) const { return hub_->status().at(sensor).state_reason; }

  int lines_of_log_with(const std::string& text) const {
    std::istringstream lines(log_.str());
    int count = 0;
    for (std::string line; std::getline(lines, line);) count += line.find(text) != std::string::npos ? 1 : 0;
    return count;
  }

  static constexpr int kTicksPerSecond = 5;

  ManualClock clock_;
  settings::Config config_;
  std::deque<SensorControl> controls_;
  std::vector<drivers::sensor::Sink*> sinks_;
  std::unique_ptr<SensorHub> hub_;
  wind::ReadingQuality quality_ = wind::ReadingQuality::kGood;
  int recorded_ = 0;
  double largest_wind_m_s_ = 0.0;
  double largest_step_m_s_ = 0.0;
  std::ostringstream log_;
  std::shared_ptr<spdlog::logger> usual_logger_;
};

class SensorJudgementOfTwo : public SensorJudgement {
 protected:
  SensorJudgementOfTwo() : SensorJudgement(2) {}
};
class SensorJudgementOfThree : public SensorJudgement {
 protected:
  SensorJudgementOfThree() : SensorJudgement(3) {}
};

// A sensor of maxima is read, judged, shown and recorded, but not used as wind.
TEST_F(SensorJudgementOfTwo, AMaximumIsShownAndMakesNoWind) {
  config_.sensors[0].value = {.value = wind::ReadingValue::kMaximum, .averaging_s = 60.0, .source = "its manual"};
  config_.sensors[0].blend.value = wind::ReadingValue::kMaximum;
  start();
  go_on(600, [&] { publish(0, breeze(12.0)); });
  EXPECT_EQ(state(0), wind::judging::SensorState::kLive);
  EXPECT_EQ(recorded_, 600);
  EXPECT_EQ(hub_->status()[0].value, "maximum over 60 s (its manual)");
  EXPECT_GT(*hub_->status()[0].speed_m_s, 9.0);
  EXPECT_THAT(reason(0), HasSubstr("its speeds are maxima, which are not used as wind. Set the station to send"));
  EXPECT_FALSE(hub_->is_any_live()) << "a recording may stand in for it";
  EXPECT_EQ(hub_->wind().source, wind::Source::kDefault);

  // Beside another sensor it neither makes the wind nor outvotes it.
  go_on(600, [&] {
    publish(0, breeze(12.0));
    publish(1, breeze(5.0));
  });
  EXPECT_EQ(state(1), wind::judging::SensorState::kLive);
  EXPECT_EQ(hub_->status()[1].value, "instantaneous (assumed)");
  EXPECT_NEAR(speed_of(hub_->wind().wind), 5.0, 2.0);
  EXPECT_EQ(lines_of_log_with("outvoted"), 0);
}

TEST_F(SensorJudgement, AFrozenSensorLosesTheWindWithoutAJumpAndGetsItBackWhenItMoves) {
  start();
  go_on(120, [&] { publish(0, breeze()); });
  EXPECT_EQ(state(), wind::judging::SensorState::kLive);
  EXPECT_EQ(hub_->wind().source, wind::Source::kLive);
  const double normal_step_m_s = std::exchange(largest_step_m_s_, 0.0);

  go_on(60, [&] { publish(0, 6.5); });
  EXPECT_EQ(state(), wind::judging::SensorState::kFrozen);
  EXPECT_THAT(reason(), HasSubstr("the same reading, 6.50 m/s, 60 times"));
  EXPECT_EQ(hub_->status()[0].health, wind::SourceHealth::kLive) << "it speaks";
  EXPECT_EQ(hub_->status()[0].speed_m_s, 6.5) << "what it says is shown";
  go_on(60, [&] { publish(0, 6.5); });
  EXPECT_NE(hub_->wind().source, wind::Source::kLive);

  go_on(30, [&] { publish(0, breeze()); });
  EXPECT_EQ(state(), wind::judging::SensorState::kLive);
  EXPECT_EQ(hub_->wind().source, wind::Source::kLive);
  EXPECT_LT(largest_step_m_s_, 2.0 * normal_step_m_s) << "neither loss nor return is a jump";
  EXPECT_EQ(recorded_, 270) << "a recording keeps everything";

  EXPECT_EQ(lines_of_log_with("warning sensor spoken0: frozen: the same reading, 6.50 m/s"), 1) << log_.str();
  EXPECT_EQ(lines_of_log_with("(was frozen"), 1) << log_.str();
  EXPECT_EQ(lines_of_log_with("sensor spoken0"), 4) << "connected, live, frozen, live\n" << log_.str();
}

TEST_F(SensorJudgement, SpikesDoNotReachTheWind) {
  start();
  go_on(60, [&] { publish(0, breeze()); });
  const double normal_wind_m_s = std::exchange(largest_wind_m_s_, 0.0);
  int second = 0;
  go_on(300, [&] { publish(0, second++ % 20 == 0 ? 55.0 : breeze()); });
  EXPECT_EQ(state(), wind::judging::SensorState::kLive) << "one in twenty is no fault";
  EXPECT_LT(largest_wind_m_s_, 1.5 * normal_wind_m_s);
  EXPECT_EQ(recorded_, 360);
  EXPECT_THAT(hub_->status()[0].refused, ::testing::Contains(std::pair<std::string, std::uint64_t>("rejected", 15)));
}

TEST_F(SensorJudgement, ASensorThatSaysNonsenseAgainAndAgainIsImplausibleUntilItSpeaksSense) {
  start();
  go_on(60, [&] { publish(0, breeze()); });
  go_on(30, [&] { publish(0, kNan); });
  EXPECT_EQ(state(), wind::judging::SensorState::kImplausible);
  EXPECT_THAT(reason(), HasSubstr("of its last readings"));
  go_on(90, [&] { publish(0, breeze()); });
  EXPECT_EQ(state(), wind::judging::SensorState::kLive);
  EXPECT_EQ(lines_of_log_with("implausible: "), 1) << log_.str();
}

TEST_F(SensorJudgement, ASimulationMayBeAsSteadyAsItLikesAndSoMayOneThatIsNotJudged) {
  quality_ = wind::ReadingQuality::kSimulated;
  start();
  go_on(900, [&] { publish(0, 6.0); });
  EXPECT_EQ(state(), wind::judging::SensorState::kSimulated);
  EXPECT_EQ(hub_->wind().source, wind::Source::kLive);
}

TEST_F(SensorJudgement, NothingIsJudgedWhereTheConfigurationSaysSo) {
  config_.sensors[0].judge.reset();
  start();
  go_on(60, [&] { publish(0, breeze()); });
  go_on(300, [&] { publish(0, 6.0); });
  EXPECT_EQ(state(), wind::judging::SensorState::kLive);
  EXPECT_EQ(hub_->wind().source, wind::Source::kLive);
}

TEST_F(SensorJudgement, LimitsComeFromTheConfiguration) {
  config_.sensors[0].judge->frozen_s = 100.0;
  config_.sensors[0].judge->max_speed_m_s = 40.0;
  start();
  go_on(60, [&] { publish(0, breeze()); });
  go_on(95, [&] { publish(0, 6.0); });
  EXPECT_EQ(state(), wind::judging::SensorState::kLive);
  go_on(10, [&] { publish(0, 6.0); });
  EXPECT_EQ(state(), wind::judging::SensorState::kFrozen);
  go_on(30, [&] { publish(0, 41.0 + 0.1 * breeze()); });
  EXPECT_EQ(state(), wind::judging::SensorState::kImplausible);
}

/// The configuration with another calibration of one sensor, as a file would have it.
settings::Config recalibrated(settings::Config config, std::size_t sensor, double gain) {
  settings::SensorConfig& changed = config.sensors[sensor];
  changed.by_name.at("calibration").set("gain", gain);
  changed.calibration = settings::calibration_of(changed.by_name.at("calibration"));
  return config;
}

TEST_F(SensorJudgement, ANewCalibrationIsNoSpikeAndNoJumpAndCostsNoReading) {
  start();
  go_on(300, [&] { publish(0, breeze()); });
  const double normal_step_m_s = std::exchange(largest_step_m_s_, 0.0);
  hub_->change(recalibrated(config_, 0, 2.5));
  go_on(60, [&] {
    publish(0, breeze());
    EXPECT_EQ(state(), wind::judging::SensorState::kLive);
  });
  EXPECT_EQ(hub_->status()[0].readings, 360U) << "counts go on";
  EXPECT_TRUE(hub_->status()[0].refused.empty()) << "every reading was believed";
  EXPECT_EQ(recorded_, 360);
  EXPECT_NEAR(hub_->status()[0].speed_m_s.value_or(0.0), 2.5 * hub_->status()[0].raw_speed_m_s.value_or(0.0), 1e-9);
  EXPECT_EQ(hub_->wind().source, wind::Source::kLive);
  EXPECT_GT(largest_wind_m_s_, 12.0);
  EXPECT_LT(largest_step_m_s_, 6.0 * normal_step_m_s) << "as a gust of this size";
  EXPECT_EQ(lines_of_log_with("warning"), 0) << log_.str();

  // Back to a fifth: spikes would be as far below.
  hub_->change(recalibrated(config_, 0, 0.5));
  go_on(60, [&] {
    publish(0, breeze());
    EXPECT_EQ(state(), wind::judging::SensorState::kLive);
  });
  EXPECT_TRUE(hub_->status()[0].refused.empty());
}

TEST_F(SensorJudgement, ANewCalibrationDoesNotMakeAFrozenSensorMoveOrAMovingOneFrozen) {
  start();
  go_on(120, [&] { publish(0, breeze()); });
  go_on(20, [&] { publish(0, 6.5); });
  hub_->change(recalibrated(config_, 0, 1.2));
  go_on(9, [&] { publish(0, 6.5); });
  EXPECT_EQ(state(), wind::judging::SensorState::kLive) << "29 s and 29 readings, 30 make it frozen";
  go_on(10, [&] { publish(0, 6.5); });
  EXPECT_EQ(state(), wind::judging::SensorState::kFrozen) << "the calibration has not made it move";
  hub_->change(recalibrated(config_, 0, 1.4));
  go_on(20, [&] {
    publish(0, 6.5);
    EXPECT_EQ(state(), wind::judging::SensorState::kFrozen);
  });
  go_on(30, [&] { publish(0, breeze()); });
  EXPECT_EQ(state(), wind::judging::SensorState::kLive);
}

TEST_F(SensorJudgement, JudgingCanBeChangedSwitchedOffAndOn) {
  start();
  go_on(120, [&] { publish(0, breeze()); });
  go_on(60, [&] { publish(0, 6.5); });
  EXPECT_EQ(state(), wind::judging::SensorState::kFrozen);
  settings::Config lenient = config_;
  lenient.sensors[0].judge->frozen_s = 1000.0;
  hub_->change(lenient);
  go_on(2, [&] { publish(0, 6.5); });
  EXPECT_EQ(state(), wind::judging::SensorState::kLive) << "62 s are not frozen any more";

  settings::Config unjudged = config_;
  unjudged.sensors[0].judge.reset();
  hub_->change(unjudged);
  go_on(60, [&] { publish(0, 70.0); });
  EXPECT_EQ(state(), wind::judging::SensorState::kLive);
  hub_->change(config_);
  go_on(60, [&] { publish(0, breeze()); });
  EXPECT_EQ(state(), wind::judging::SensorState::kLive) << "and begins without what it has not judged";
}

TEST_F(SensorJudgementOfThree, ANewCalibrationOfOneIsNoContradiction) {
  start();
  const auto all_say = [&] {
    for (std::size_t sensor = 0; sensor < 3; ++sensor) publish(sensor, breeze());
  };
  go_on(1200, all_say);
  // What it said until now would be far from the others, and what it says from now on is right.
  hub_->change(recalibrated(config_, 2, 9.0));
  go_on(1500, [&] {
    publish(0, breeze());
    publish(1, breeze());
    publish(2, breeze() / 9.0);
    EXPECT_EQ(state(2), wind::judging::SensorState::kLive);
  });
  EXPECT_EQ(lines_of_log_with("warning"), 0) << log_.str();
  // A wrong one is found out by the others, as ever.
  hub_->change(recalibrated(config_, 2, 90.0));
  go_on(1500, [&] {
    publish(0, breeze());
    publish(1, breeze());
    publish(2, breeze() / 9.0);
  });
  EXPECT_EQ(state(2), wind::judging::SensorState::kImplausible);
}

TEST_F(SensorJudgement, ARecordingIsJudgedAsTheSensorWasAndNeverTakenForLive) {
  config_.sensors.clear();
  add_sensor(kPlayedDriver);
  start();
  go_on(60, [&] { publish(0, breeze()); });
  EXPECT_EQ(state(), wind::judging::SensorState::kReplayed);
  go_on(60, [&] { publish(0, 5.0); });
  EXPECT_EQ(state(), wind::judging::SensorState::kFrozen);
  EXPECT_TRUE(hub_->status()[0].replayed);
  sinks_[0]->link(wind::LinkState::kFinished, "the end");
  go_on(30, [] {});
  EXPECT_EQ(state(), wind::judging::SensorState::kDisconnected);
}

TEST_F(SensorJudgement, SilenceIsStaleAndADeviceThatGoesIsDisconnected) {
  start();
  EXPECT_EQ(state(), wind::judging::SensorState::kConnecting);
  go_on(30, [&] { publish(0, breeze()); });
  go_on(10, [] {});
  EXPECT_EQ(state(), wind::judging::SensorState::kStale);
  EXPECT_THAT(reason(), HasSubstr("no reading for 10"));
  sinks_[0]->link(wind::LinkState::kConnecting, "its cable is out");
  go_on(1, [] {});
  EXPECT_EQ(state(), wind::judging::SensorState::kDisconnected);
  EXPECT_EQ(reason(), "its cable is out");
}

TEST_F(SensorJudgement, AMessageThatIsRepeatedIsJudgedOnceAndNeverStale) {
  start();
  int second = 0;
  int stale = 0;
  double said_m_s = 0.0;
  go_on(1800, [&] {
    const int of_burst = second++ % 18;  // Acurite's 5-in-1 says each message three times every 18 s
    if (of_burst == 0) said_m_s = second == 18 * 60 + 1 ? 90.0 : breeze();
    if (of_burst < 3) publish(0, said_m_s);
    if (state() == wind::judging::SensorState::kStale) ++stale;
  });
  EXPECT_EQ(stale, 0);
  EXPECT_EQ(recorded_, 300) << "a recording keeps everything";
  EXPECT_EQ(hub_->wind().source, wind::Source::kLive);
  EXPECT_THAT(reason(), HasSubstr("a reading every 18 s"));
  EXPECT_THAT(hub_->status()[0].refused, ::testing::Contains(std::pair<std::string, std::uint64_t>("rejected", 3)))
      << "the spike, and what repeats it";
  EXPECT_LT(largest_wind_m_s_, 30.0);
}

TEST_F(SensorJudgement, ASensorThatSpeaksOnChangeIsSilentInACalmThatLasts) {
  config_.sensors[0].blend.unchanged_for_s = 3600.0;
  start();
  go_on(60, [&] { publish(0, breeze()); });
  publish(0, 0.0);
  go_on(600, [] {});
  largest_wind_m_s_ = 0.0;
  go_on(2700, [] {});
  EXPECT_LT(largest_wind_m_s_, 0.1) << "no wind is invented";
  EXPECT_EQ(state(), wind::judging::SensorState::kLive);
  EXPECT_THAT(reason(), HasSubstr("none for 55"));
  go_on(360, [] {});
  EXPECT_EQ(state(), wind::judging::SensorState::kStale);
}

TEST_F(SensorJudgement, WhatAConnectedSensorSaysAnewOfItselfIsLoggedOnce) {
  start();
  go_on(30, [&] { publish(0, breeze()); });
  sinks_[0]->link(wind::LinkState::kConnected, "there, with the direction of another");
  go_on(30, [&] { publish(0, breeze()); });
  EXPECT_EQ(lines_of_log_with("connected: here"), 1) << log_.str();
  EXPECT_EQ(lines_of_log_with("connected: there, with the direction of another"), 1) << log_.str();
}

TEST_F(SensorJudgement, AFlappingSensorDoesNotFloodTheLog) {
  start();
  int second = 0;
  go_on(3600, [&] {
    if (second++ % 20 < 8) publish(0, breeze());  // twelve seconds of silence: stale
  });
  EXPECT_GE(lines_of_log_with("sensor spoken0: stale"), 1);
  EXPECT_LE(lines_of_log_with("sensor spoken0"), 14) << log_.str();
}

TEST_F(SensorJudgementOfThree, TheOneThatIsOutvotedLosesTheWindToTheNext) {
  start();
  const auto all_say = [&](double first_m_s) {
    publish(0, breeze(first_m_s));
    publish(1, breeze(5.0), 251.0);
    publish(2, breeze(6.0), 249.0);
  };
  go_on(60, [&] { all_say(5.5); });
  go_on(1000, [&] { all_say(33.0); });
  EXPECT_EQ(state(0), wind::judging::SensorState::kImplausible);
  EXPECT_THAT(reason(0), HasSubstr("m/s, that of the other sensors 5"));
  EXPECT_EQ(state(1), wind::judging::SensorState::kLive);
  EXPECT_EQ(state(2), wind::judging::SensorState::kLive);
  go_on(60, [&] { all_say(33.0); });
  EXPECT_EQ(hub_->wind().source, wind::Source::kLive);
  EXPECT_LT(speed_of(hub_->wind().wind), 12.0) << "the next one's";
  go_on(1000, [&] { all_say(5.5); });
  EXPECT_EQ(state(0), wind::judging::SensorState::kLive);
}

TEST_F(SensorJudgementOfThree, WhoIsNotToBeComparedIsNeverOutvoted) {
  config_.sensors[0].is_compared = false;
  start();
  go_on(1000, [&] {
    publish(0, breeze(33.0));
    publish(1, breeze(5.0));
    publish(2, breeze(6.0));
  });
  EXPECT_EQ(state(0), wind::judging::SensorState::kLive);
}

TEST_F(SensorJudgementOfTwo, TwoThatDifferAreReportedOnceAndBothBelieved) {
  start();
  go_on(1000, [&] {
    publish(0, breeze(3.0));
    publish(1, breeze(25.0));
  });
  for (const std::size_t sensor : {0U, 1U}) {
    EXPECT_EQ(state(sensor), wind::judging::SensorState::kLive);
    EXPECT_THAT(reason(sensor), HasSubstr("Check each sensor"));
  }
  EXPECT_EQ(lines_of_log_with("warning sensor spoken0: live: a reading every 1 s; but its mean of 5 min is"), 1)
      << log_.str();
  EXPECT_EQ(lines_of_log_with("Check each sensor"), 2) << log_.str();
}

TEST_F(SensorJudgementOfTwo, TwoThatDifferByAFactorAreLevelledAndARestartGoesOn) {
  start();
  const auto both_speak = [&] {
    publish(0, breeze(7.5));
    publish(1, breeze(5.0));
  };
  go_on(250, both_speak);
  EXPECT_EQ(hub_->status()[0].reads_times_group, 1.0) << "a mean of five minutes comes first";
  EXPECT_TRUE(hub_->relative_gains().empty());
  go_on(50 * 60, both_speak);
  EXPECT_NEAR(hub_->status()[0].reads_times_group, std::sqrt(1.5), 0.04);
  EXPECT_NEAR(hub_->status()[1].reads_times_group, 1.0 / std::sqrt(1.5), 0.04);
  EXPECT_NEAR(*hub_->status()[0].speed_m_s, 7.5, 1.5) << "its readings are shown";

  const wind::judging::LearntByName learnt = hub_->relative_gains();
  controls_.resize(2 * config_.sensors.size());
  SensorHub next(config_, clock_, make_gust_noise(config_), {}, 0.0, SensorThread::kOfCaller);
  ASSERT_TRUE(next.restore_relative_gains(learnt));
  EXPECT_NEAR(next.status()[0].reads_times_group, hub_->status()[0].reads_times_group, 1e-9);
  EXPECT_FALSE(next.restore_relative_gains({{"spoken0", {.deviation = 3.0, .learnt_s = 60.0}}}));
}

TEST_F(SensorJudgementOfTwo, EachReadsAsItSaysWhereGainsAreOff) {
  config_.wind.has_relative_gains = false;
  start();
  go_on(1200, [&] {
    publish(0, breeze(7.5));
    publish(1, breeze(5.0));
  });
  EXPECT_EQ(hub_->status()[0].reads_times_group, 1.0);
  EXPECT_TRUE(hub_->relative_gains().empty());
}

// The estimator knows what is said again, and what is held, by its bits.
TEST(SensorJury, WhatIsSaidAgainIsLevelledAsTheFirstTime) {
  const JuryRules rules{.judge = wind::judging::JudgeSettings{}, .is_compared = true};
  SensorJury jury({rules, rules}, 5.0, true);
  const auto reading_at = [](double time_s, double speed_m_s) {
    wind::Reading reading;
    reading.time.mono = MonoTime(from_seconds(time_s));
    reading.speed_m_s = speed_m_s;
    reading.gust_m_s = 1.5 * speed_m_s;
    return reading;
  };
  const wind::Reading untouched = reading_at(999.0, 5.5);
  jury.hear(0, untouched);
  EXPECT_TRUE(has_same_values(jury.levelled(0, untouched), untouched)) << "nothing is known";
  using Learnt = wind::judging::GroupGains::Learnt;
  ASSERT_TRUE(jury.restore_gains(std::vector<Learnt>{{0.2, 3600.0}, {-0.2, 3600.0}}));
  const wind::Reading first = reading_at(1000.0, 6.0);
  jury.hear(0, first);
  const wind::Reading levelled = jury.levelled(0, first);
  EXPECT_NEAR(levelled.speed_m_s, 6.0 * std::exp(-0.2), 1e-12);
  EXPECT_NEAR(*levelled.gust_m_s, 9.0 * std::exp(-0.2), 1e-12);
  ASSERT_TRUE(jury.restore_gains(std::vector<Learnt>{{0.1, 3600.0}, {-0.1, 3600.0}}));
  const wind::Reading again = reading_at(1001.0, 6.0);
  jury.hear(0, again);
  EXPECT_TRUE(has_same_values(jury.levelled(0, again), levelled));
  const wind::Reading next = reading_at(1002.0, 6.1);
  jury.hear(0, next);
  EXPECT_NEAR(jury.levelled(0, next).speed_m_s, 6.1 * std::exp(-0.1), 1e-12);
}

TEST_F(SensorJudgementOfTwo, ACupThatStandsStillWhereTheOtherHasWindIsSeized) {
  config_.sensors[0].judge->seized_s = 900.0;
  start();
  const auto publish_other = [&] { publish(1, breeze(7.0)); };
  go_on(60, [&] { publish(0, breeze()), publish_other(); });
  go_on(1400, [&] { publish(0, 0.0), publish_other(); });
  EXPECT_EQ(state(0), wind::judging::SensorState::kSeized);
  EXPECT_THAT(reason(0), HasSubstr("while the other sensors measure 7"));
  EXPECT_GT(speed_of(hub_->wind().wind), 3.0) << "the other's wind";
  go_on(20, [&] { publish(0, breeze()), publish_other(); });
  EXPECT_EQ(state(0), wind::judging::SensorState::kLive);
}

/// Whatever happens, the wind stays one, and in the end everything is as it should be.
TEST_F(SensorJudgementOfTwo, RandomFaultsLeaveTheWindFiniteAndBoundedAndTheStatesEndRight) {
  start();
  std::mt19937_64 random(17);
  const auto chance = [&](unsigned one_in) { return random() % one_in == 0; };
  constexpr double kTenYears_s = 315'576'000.0;
  double frozen_m_s = -1.0;
  for (int episode = 0; episode < 100; ++episode) {
    const std::uint64_t fault = random() % 9;
    const std::size_t sensor = random() % 2;
    if (fault == 0) clock_.set_utc(clock_.now().utc + from_seconds(chance(2) ? kTenYears_s : -kTenYears_s));
    frozen_m_s = breeze();
    go_on(5.0 + static_cast<double>(random() % 40), [&] {
      publish(1 - sensor, breeze());
      switch (fault) {
        case 1:
          return;  // silence
        case 2:
          return publish(sensor, chance(3) ? kNan : breeze());
        case 3:
          return publish(sensor, chance(4) ? 0.1 * static_cast<double>(random() % 1200) : breeze());
        case 4:
          return publish(sensor, frozen_m_s);
        case 5:  // late ones, and such as come from the future
          return publish(sensor, breeze(), 250.0, chance(2) ? 3.0 : -kTenYears_s);
        case 6:
          for (int i = 0; i < 12; ++i) publish(sensor, breeze(), static_cast<double>(random() % 360));
          return;
        case 7:
          sinks_[sensor]->link(chance(2) ? wind::LinkState::kConnected : wind::LinkState::kConnecting, "flaps");
          return;
        case 8:
          return publish(sensor, 0.0);
        default:
          return publish(sensor, breeze());
      }
    });
    if (HasFatalFailure()) return;
    if (chance(20)) clock_.advance(from_seconds(chance(3) ? kTenYears_s : 3600.0));  // the machine slept
    if (chance(20)) clock_.advance(-from_seconds(2.0));
  }
  EXPECT_LE(largest_wind_m_s_, wind::kMaxPlausibleSpeed_m_s);

  for (drivers::sensor::Sink* sink : sinks_) sink->link(wind::LinkState::kConnected, "here");
  wind::Vector sum{};
  int seconds_seen = 0;
  go_on(180, [&] {
    publish(0, breeze());
    publish(1, breeze());
    if (++seconds_seen > 120) sum = sum + hub_->wind().wind;
  });
  EXPECT_EQ(state(0), wind::judging::SensorState::kLive) << reason(0);
  EXPECT_EQ(state(1), wind::judging::SensorState::kLive) << reason(1);
  EXPECT_EQ(hub_->wind().source, wind::Source::kLive);
  EXPECT_NEAR(speed_of(sum) / 60.0, 6.0, 2.0);
}

}  // namespace
}  // namespace yuragi::daemon::sensing
