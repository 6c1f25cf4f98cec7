// The recording that is played while every sensor is silent.
#include "daemon/sensing/fallback_recording.hpp"

#include <atomic>
#include <fstream>

#include <gtest/gtest.h>

#include "daemon/sensing/sensor_hub.hpp"
#include "tests/drivers/windlog/windlog_samples.hpp"
#include "tests/support/gusty_wind.hpp"
#include "tests/support/manual_clock.hpp"
#include "tests/support/temporary_folder.hpp"

namespace yuragi::daemon::sensing {
namespace {

using namespace std::chrono_literals;
using test::write_session;

/// A sensor that speaks ten times a second while `is_sending`.
std::atomic<bool> is_sending{false};

class WilfulSensor final : public drivers::sensor::Sensor {
 public:
  MonoTime poll(const drivers::sensor::Clock& clock, drivers::sensor::Sink& sink) override {
    const Instant now = clock.now();
    if (is_sending && now.mono - last_ >= 100ms) {
      wind::Reading reading;
      reading.time = now;
      reading.speed_m_s = 12.0;
      reading.direction_deg = 270.0;
      sink.reading(reading);
      last_ = now.mono;
    }
    return now.mono + 1ms;
  }

 private:
  MonoTime last_{};
};

const drivers::sensor::DriverDescription kWilfulDriver{
    .name = "wilful",
    .summary = "",
    .parameters = {},
    .open = [](const ParameterValues&) -> std::unique_ptr<drivers::sensor::Sensor> {
      return std::make_unique<WilfulSensor>();
    }};

class FallbackRecordingTest : public ::testing::Test {
 protected:
  FallbackRecordingTest() {
    is_sending = false;
    std::vector<wind::Reading> readings;
    readings.reserve(1500);
    for (std::int64_t i = 0; i < 1500; ++i) {
      readings.push_back(test::reading_at(20 * i, 4.0));
      readings.back().direction_deg = 270.0;
    }
    test::write_session(file(), readings, "mast");
    config_ = settings::default_config();
    config_.sensors = {settings::default_sensor("roof", kWilfulDriver, {}),
                       settings::default_sensor("yard", kWilfulDriver, {})};
    config_.wind.default_speed_m_s = 1.0;
    config_.wind.default_direction_deg = 270.0;
    config_.wind.default_turbulence_intensity = 0.0;
    config_.wind.fallback = {.recording = file(), .after_s = 5.0};
  }

  std::filesystem::path file() const { return folder_ / "calm.windlog"; }

  /// Ticks, each when the sensors' threads have done what was due, until the condition holds; false if it does not for
  /// two minutes of the clock's. Watches that the wind makes no step.
  bool tick_until(SensorHub& hub, const std::function<bool()>& condition) {
    for (int tick = 0; tick < 120 * 60; ++tick) {
      if (condition()) return true;
      clock_.advance(from_seconds(1.0 / 60.0));
      if (!clock_.wait_for_waiters(hub.status().size())) return false;
      const wind::Vector wind = hub.advance().wind;
      if (tick > 0 || has_ticked_) largest_step_m_s_ = std::max(largest_step_m_s_, speed_of(wind - last_));
      last_ = wind;
      has_ticked_ = true;
    }
    return false;
  }
  static bool plays(const SensorHub& hub) {
    const auto status = hub.status();
    return status.size() == 3 && status[2].readings > 0;
  }

  test::TemporaryFolder folder_;
  ManualClock clock_;
  settings::Config config_;
  wind::Vector last_{};
  double largest_step_m_s_ = 0.0;
  bool has_ticked_ = false;
};

TEST_F(FallbackRecordingTest, PlaysWhileEverySensorIsSilentAndEndsWhenOneIsLiveAgain) {
  std::vector<double> recorded;
  SensorHub hub(config_, clock_, shared_gusts(),
                [&](std::size_t, const wind::Reading& reading) { recorded.push_back(reading.speed_m_s); });
  is_sending = true;
  ASSERT_TRUE(tick_until(hub, [&] { return last_.u_m_s > 11.0; })) << "the sensors' wind";
  EXPECT_EQ(hub.status().size(), 2U);

  is_sending = false;
  const MonoTime silent = clock_.now().mono;
  ASSERT_TRUE(tick_until(hub, [&] { return plays(hub); }));
  EXPECT_GE(clock_.now().mono - silent, 5s);
  const wire::SensorStatus status = hub.status().at(2);
  EXPECT_EQ(status.name, "fall-back");
  EXPECT_TRUE(status.replayed);
  EXPECT_NE(status.detail.find("all sensors are silent"), std::string::npos);
  EXPECT_NE(status.detail.find("calm.windlog"), std::string::npos);
  ASSERT_TRUE(tick_until(hub, [&] { return std::abs(last_.u_m_s - 4.0) < 0.3; })) << "the recording's wind";
  EXPECT_EQ(std::ranges::count(recorded, 4.0), 0) << "no sensor said that";

  is_sending = true;
  ASSERT_TRUE(tick_until(hub, [&] { return hub.status().size() == 2; }));
  ASSERT_TRUE(tick_until(hub, [&] { return last_.u_m_s > 11.0; }));
  // From 12 to 4 m/s and back, over 3 s: critically damped, at most 0.37 w e a second with w = 4/3 for the weight, and
  // as much again for its trust. A hard switch would be 8.
  EXPECT_LT(largest_step_m_s_, 0.8);
}

TEST_F(FallbackRecordingTest, GetsTheCalibrationOfTheSensorThatWasRecorded) {
  config_.sensors[1].name = "mast";
  config_.sensors[1].calibration.gain = 2.0;
  SensorHub hub(config_, clock_, shared_gusts());
  ASSERT_TRUE(tick_until(hub, [&] { return plays(hub); }));
  EXPECT_EQ(hub.status().at(2).speed_m_s, 8.0);
}

TEST_F(FallbackRecordingTest, ASpikeThatWasRecordedMovesNothing) {
  std::vector<wind::Reading> readings;
  readings.reserve(1500);
  for (std::int64_t i = 0; i < 1500; ++i) readings.push_back(test::reading_at(20 * i, i % 40 == 39 ? 60.0 : 4.0));
  std::filesystem::remove(file());
  test::write_session(file(), readings, "mast");
  SensorHub hub(config_, clock_, shared_gusts());
  ASSERT_TRUE(tick_until(hub, [&] { return plays(hub) && hub.status()[2].readings > 400; }));
  EXPECT_LT(hub.status()[2].speed_m_s, 5.0);
  EXPECT_LT(largest_step_m_s_, 0.8);
}

TEST_F(FallbackRecordingTest, ThatVanishedGivesWayToTheDefaultWind) {
  SensorHub hub(config_, clock_, shared_gusts());
  std::filesystem::remove(file());
  const MonoTime begun = clock_.now().mono;
  ASSERT_TRUE(tick_until(hub, [&] { return clock_.now().mono - begun > 15s; }));
  EXPECT_EQ(hub.status().size(), 2U);
  EXPECT_NEAR(last_.u_m_s, 1.0, 0.2);

  // And is played when it is there again.
  test::write_session(file(), {test::reading_at(0, 4.0), test::reading_at(1000, 4.0)}, "mast");
  EXPECT_TRUE(tick_until(hub, [&] { return plays(hub); }));
}

TEST_F(FallbackRecordingTest, ThatCannotBePlayedIsAMistakeOfTheConfiguration) {
  const auto complaint = [&](const std::string& text) -> std::string {
    try {
      const settings::Config config = settings::parse_config(text, "wall.toml");
      SensorHub hub(config, clock_, shared_gusts());
      return "";
    } catch (const settings::ConfigError& error) {
      return error.what();
    }
  };
  EXPECT_EQ(complaint("[wind]\nfallback_recording = \"" + file().string() + "\"\n"), "");
  EXPECT_EQ(complaint("[wind]\nfallback_recording = \"\"\n"), "");
  EXPECT_EQ(complaint("[wind]\nfallback_recording = \"/no/such.windlog\"\n"),
            "wall.toml:2:22: wind.fallback_recording: /no/such.windlog: the recording does not exist");
  std::ofstream(folder_ / "damaged.windlog") << "not a recording";
  EXPECT_NE(complaint("[wind]\nfallback_recording = \"" + (folder_ / "damaged.windlog").string() + "\"\n"), "");
  test::write_session(folder_ / "empty.windlog", {});
  EXPECT_NE(
      complaint("[wind]\nfallback_recording = \"" + (folder_ / "empty.windlog").string() + "\"\n").find("no reading"),
      std::string::npos);
}

}  // namespace
}  // namespace yuragi::daemon::sensing
