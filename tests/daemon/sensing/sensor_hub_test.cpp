#include "daemon/sensing/sensor_hub.hpp"

#include <future>
#include <limits>
#include <stdexcept>
#include <utility>

#include <gtest/gtest.h>

#include "tests/support/gusty_wind.hpp"
#include "tests/support/manual_clock.hpp"

namespace yuragi::daemon::sensing {
namespace {

/// What the sensor under test does when it is polled; set before the hub is made.
struct Script {
  std::function<void(const drivers::sensor::Clock&, drivers::sensor::Sink&)> first_poll;
  std::promise<void> polled, interrupted;
  bool wait_for_interrupt = false;
};
Script* script = nullptr;

class ScriptedSensor final : public drivers::sensor::Sensor {
 public:
  MonoTime poll(const drivers::sensor::Clock& clock, drivers::sensor::Sink& sink) override {
    if (!done_) {
      done_ = true;
      script->first_poll(clock, sink);
      script->polled.set_value();
      if (script->wait_for_interrupt) script->interrupted.get_future().wait();
    }
    return MonoTime::max();
  }
  void interrupt() noexcept override {
    if (script->wait_for_interrupt) script->interrupted.set_value();
  }

 private:
  bool done_ = false;
};

const drivers::sensor::DriverDescription kScriptedDriver{
    .name = "scripted",
    .summary = "",
    .parameters = {},
    .open = [](const ParameterValues&) -> std::unique_ptr<drivers::sensor::Sensor> {
      return std::make_unique<ScriptedSensor>();
    }};

class SensorHubTest : public ::testing::Test {
 protected:
  SensorHubTest() {
    script = &script_;
    config_ = settings::default_config();
    config_.sensors = {settings::default_sensor("roof", kScriptedDriver, {}, "wall.toml:3:1")};
  }

  ManualClock clock_;
  Script script_;
  settings::Config config_;
};

wind::Reading reading_at(const drivers::sensor::Clock& clock, double speed_m_s) {
  wind::Reading reading;
  reading.time = clock.now();
  reading.speed_m_s = speed_m_s;
  reading.direction_deg = 90.0;
  return reading;
}

/// The wind of a hub after 10 s of ticks.
wind::State wind_after_a_while(SensorHub& hub, ManualClock& clock) {
  for (int tick = 0; tick < 600; ++tick) {
    hub.advance();
    clock.advance(from_seconds(1.0 / 60.0));
  }
  return hub.advance();
}

TEST_F(SensorHubTest, CalibratesForTheWindAndLeavesTheRecordingWhatTheSensorSaid) {
  config_.wind.default_turbulence_intensity = 0.0;
  script_.first_poll = [](const drivers::sensor::Clock& clock, drivers::sensor::Sink& sink) {
    sink.reading(reading_at(clock, 6.0));
  };
  config_.sensors[0].calibration.gain = 1.5;
  config_.sensors[0].calibration.north_offset_deg = 180.0;
  std::vector<double> received;
  SensorHub hub(config_, clock_, shared_gusts(),
                [&](std::size_t, const wind::Reading& reading) { received.push_back(reading.speed_m_s); });
  script_.polled.get_future().wait();
  EXPECT_NEAR(wind_after_a_while(hub, clock_).wind.u_m_s, 9.0, 0.2) << "from west, where the mark said east";
  EXPECT_EQ(received, std::vector{6.0});
  EXPECT_EQ(hub.status()[0].speed_m_s, 9.0);
  EXPECT_EQ(hub.status()[0].raw_speed_m_s, 6.0);
  EXPECT_EQ(hub.status()[0].raw_direction_deg, 90.0);
}

TEST_F(SensorHubTest, BringsReadingsToTheWindAndToTheListener) {
  config_.wind.default_turbulence_intensity = 0.0;
  script_.first_poll = [](const drivers::sensor::Clock& clock, drivers::sensor::Sink& sink) {
    sink.link(wind::LinkState::kConnected, "here");
    sink.reading(reading_at(clock, 6.0));
  };
  std::vector<double> received;
  SensorHub hub(config_, clock_, shared_gusts(), [&](std::size_t sensor, const wind::Reading& reading) {
    EXPECT_EQ(sensor, 0U);
    received.push_back(reading.speed_m_s);
  });
  script_.polled.get_future().wait();

  const wind::State state = wind_after_a_while(hub, clock_);
  EXPECT_EQ(received, std::vector{6.0});
  EXPECT_NE(state.source, wind::Source::kDefault);
  EXPECT_NEAR(state.wind.u_m_s, -6.0, 0.2);

  const std::vector<wire::SensorStatus> status = hub.status();
  ASSERT_EQ(status.size(), 1U);
  EXPECT_EQ(status[0].name, "roof");
  EXPECT_EQ(status[0].readings, 1U);
  EXPECT_EQ(status[0].speed_m_s, 6.0);
  EXPECT_EQ(status[0].detail, "here");
  EXPECT_NEAR(status[0].age_s, 10.0, 1e-3);
}

TEST_F(SensorHubTest, AVaneThatFallsSilentIsMissedWhileTheCupTurns) {
  script_.first_poll = [](const drivers::sensor::Clock& clock, drivers::sensor::Sink& sink) {
    sink.link(wind::LinkState::kConnected, "here");
    for (int second = 0; second < 240; ++second) {
      wind::Reading reading = reading_at(clock, 4.0 + 0.01 * second);
      reading.time.mono -= std::chrono::seconds(240 - second);
      if (second > 60) reading.direction_deg.reset();
      sink.reading(reading);
    }
  };
  SensorHub hub(config_, clock_, shared_gusts());
  script_.polled.get_future().wait();
  hub.advance();
  const wire::SensorStatus status = hub.status().at(0);
  EXPECT_EQ(status.state, wind::judging::SensorState::kLive);
  ASSERT_EQ(status.quantities.size(), 1U) << "a gust has never come";
  EXPECT_TRUE(status.quantities[0].is_missing);
  EXPECT_NEAR(status.quantities[0].age_s.value(), 180.0, 1e-6);
  EXPECT_EQ(status.quantities[0].reason,
            "none for 3 min; the last one is kept. Check the vane, its cable and its address");
}

/// Says one reading, and then ten times a second that it still holds.
class HoldingSensor final : public drivers::sensor::Sensor {
 public:
  MonoTime poll(const drivers::sensor::Clock& clock, drivers::sensor::Sink& sink) override {
    const Instant now = clock.now();
    if (now.mono - reading_.time.mono >= std::chrono::milliseconds(100)) {
      reading_.is_held = reading_.speed_m_s > 0.0;
      reading_.time = now;
      reading_.speed_m_s = 6.0;
      sink.reading(reading_);
    }
    return now.mono + std::chrono::milliseconds(1);
  }

 private:
  wind::Reading reading_;
};

const drivers::sensor::DriverDescription kHoldingDriver{
    .name = "holding",
    .summary = "",
    .parameters = {},
    .open = [](const ParameterValues&) -> std::unique_ptr<drivers::sensor::Sensor> {
      return std::make_unique<HoldingSensor>();
    }};

TEST_F(SensorHubTest, WhatIsHeldKeepsTheSensorLiveAndIsNoReadingOfItsOwn) {
  config_.sensors[0].driver = &kHoldingDriver;
  std::atomic<int> received = 0;
  SensorHub hub(config_, clock_, shared_gusts(), [&](std::size_t, const wind::Reading&) { ++received; });
  // Two minutes: a sensor that measured the same for so long would be frozen.
  for (int tick = 0; tick < 1200; ++tick) {
    clock_.advance(std::chrono::milliseconds(100));
    ASSERT_TRUE(clock_.wait_for_waiters(1));
    hub.advance();
  }
  EXPECT_EQ(received, 1);
  EXPECT_EQ(hub.status()[0].readings, 1U);
  EXPECT_EQ(hub.status()[0].state, wind::judging::SensorState::kLive) << "two minutes after it was first said";
}

/// Throws at its first poll, and says one reading at each of the others.
class ThrowingSensor final : public drivers::sensor::Sensor {
 public:
  MonoTime poll(const drivers::sensor::Clock& clock, drivers::sensor::Sink& sink) override {
    if (!std::exchange(has_thrown_, true)) throw std::runtime_error("out of descriptors");
    sink.link(wind::LinkState::kConnected, "here");
    sink.reading(reading_at(clock, 6.0));
    return clock.now().mono + std::chrono::seconds(1);
  }

 private:
  bool has_thrown_ = false;
};

const drivers::sensor::DriverDescription kThrowingDriver{
    .name = "throwing",
    .summary = "",
    .parameters = {},
    .open = [](const ParameterValues&) -> std::unique_ptr<drivers::sensor::Sensor> {
      return std::make_unique<ThrowingSensor>();
    }};

TEST_F(SensorHubTest, ADriverThatThrowsIsAStateAndIsTriedAgain) {
  config_.sensors[0].driver = &kThrowingDriver;
  SensorHub hub(config_, clock_, shared_gusts());
  ASSERT_TRUE(clock_.wait_for_waiters(1));
  hub.advance();
  EXPECT_EQ(hub.status()[0].state, wind::judging::SensorState::kConnecting);
  EXPECT_NE(hub.status()[0].detail.find("out of descriptors"), std::string::npos) << hub.status()[0].detail;
  clock_.advance(std::chrono::seconds(10));
  ASSERT_TRUE(clock_.wait_for_waiters(1));
  hub.advance();
  EXPECT_EQ(hub.status()[0].readings, 1U);
  EXPECT_EQ(hub.status()[0].detail, "here");
}

TEST_F(SensorHubTest, CountsWhatIsRefusedAndPublishesNothingOfIt) {
  script_.first_poll = [](const drivers::sensor::Clock& clock, drivers::sensor::Sink& sink) {
    sink.refused(drivers::decode::Refusal::kTimeout);
    sink.refused(drivers::decode::Refusal::kTimeout);
    sink.reading(reading_at(clock, std::numeric_limits<double>::quiet_NaN()));
    sink.reading(reading_at(clock, -3.0));
  };
  bool received = false;
  SensorHub hub(config_, clock_, shared_gusts(), [&](std::size_t, const wind::Reading&) { received = true; });
  script_.polled.get_future().wait();
  hub.advance();

  EXPECT_FALSE(received);
  const wire::SensorStatus status = hub.status().at(0);
  EXPECT_EQ(status.readings, 0U);
  EXPECT_FALSE(status.speed_m_s.has_value());
  const std::vector<std::pair<std::string, std::uint64_t>> expected{{"timeout", 2}, {"implausible", 2}};
  EXPECT_EQ(status.refused, expected);
}

TEST_F(SensorHubTest, ASensorThatWaitsForItsDeviceDoesNotHoldUpTheEnd) {
  script_.wait_for_interrupt = true;
  script_.first_poll = [](const drivers::sensor::Clock&, drivers::sensor::Sink&) {};
  {
    const SensorHub hub(config_, clock_, shared_gusts());
    script_.polled.get_future().wait();
  }  // hangs here for ever if poll() is not interrupted
  SUCCEED();
}

TEST_F(SensorHubTest, ReadingsThatNobodyTakesAreCountedAsLost) {
  script_.first_poll = [](const drivers::sensor::Clock& clock, drivers::sensor::Sink& sink) {
    for (int count = 0; count < 2000; ++count) sink.reading(reading_at(clock, 1.0));
  };
  SensorHub hub(config_, clock_, shared_gusts());
  script_.polled.get_future().wait();
  hub.advance();
  const wire::SensorStatus status = hub.status().at(0);
  ASSERT_EQ(status.refused.size(), 1U);
  EXPECT_EQ(status.refused[0].first, "lost");
  EXPECT_EQ(status.readings + status.refused[0].second, 2000U) << "every reading is accounted for";
}

TEST_F(SensorHubTest, CountsFramesAndHowOftenTheDeviceCameAgain) {
  script_.first_poll = [](const drivers::sensor::Clock&, drivers::sensor::Sink& sink) {
    const std::vector<std::uint8_t> message = {1, 2, 3};
    sink.raw(drivers::sensor::RawDirection::kSent, message);
    for (int i = 0; i < 5; ++i) sink.raw(drivers::sensor::RawDirection::kReceived, message);
    for (const auto state : {wind::LinkState::kConnected, wind::LinkState::kConnecting, wind::LinkState::kConnected,
                             wind::LinkState::kConnecting, wind::LinkState::kConnected, wind::LinkState::kConnected}) {
      sink.link(state, "");
    }
  };
  SensorHub hub(config_, clock_, shared_gusts());
  script_.polled.get_future().wait();
  EXPECT_EQ(hub.status().at(0).frames, 5U) << "what is sent is no frame";
  EXPECT_EQ(hub.status().at(0).reconnects, 2U) << "the first connection is none";

  int kept = 0;
  hub.drain_traces([&](const wire::RawTrace&) { ++kept; });
  EXPECT_EQ(kept, 0) << "nobody asked for the messages";
}

TEST_F(SensorHubTest, HandsOnTheMessagesOfATracedSensorInTheirOrder) {
  std::promise<void> is_traced;
  script_.first_poll = [&](const drivers::sensor::Clock&, drivers::sensor::Sink& sink) {
    is_traced.get_future().wait();
    sink.raw(drivers::sensor::RawDirection::kSent, std::vector<std::uint8_t>{1, 3, 0});
    sink.raw(drivers::sensor::RawDirection::kReceived, std::vector<std::uint8_t>(700, 0x5A));
  };
  SensorHub hub(config_, clock_, shared_gusts());
  clock_.advance(std::chrono::seconds(2));
  hub.trace([](std::string_view sensor) { return sensor == "roof"; });
  is_traced.set_value();
  script_.polled.get_future().wait();

  std::vector<wire::RawTrace> traces;
  hub.drain_traces([&](const wire::RawTrace& trace) { traces.push_back(trace); });
  ASSERT_EQ(traces.size(), 2U);
  EXPECT_EQ(traces[0].sensor, "roof");
  EXPECT_FALSE(traces[0].received);
  EXPECT_EQ(traces[0].bytes, (wire::Bytes{1, 3, 0}));
  EXPECT_EQ(MonoTime(Nanoseconds(traces[0].mono_ns)), clock_.now().mono);
  EXPECT_TRUE(traces[1].received);
  EXPECT_EQ(traces[1].bytes, wire::Bytes(wire::kMaxRawBytes, 0x5A)) << "the beginning of a long one";
  EXPECT_EQ(traces[1].length, 700U);
  hub.drain_traces([&](const wire::RawTrace& trace) { traces.push_back(trace); });
  EXPECT_EQ(traces.size(), 2U) << "each once";
}

TEST_F(SensorHubTest, MessagesThatFindNoRoomAreCountedInTheNextOne) {
  std::promise<void> is_traced, is_drained, is_flooded;
  script_.first_poll = [&](const drivers::sensor::Clock&, drivers::sensor::Sink& sink) {
    const std::vector<std::uint8_t> message = {1};
    is_traced.get_future().wait();
    for (int i = 0; i < 1000; ++i) sink.raw(drivers::sensor::RawDirection::kReceived, message);
    is_flooded.set_value();
    is_drained.get_future().wait();
    sink.raw(drivers::sensor::RawDirection::kReceived, message);
  };
  SensorHub hub(config_, clock_, shared_gusts());
  hub.trace([](std::string_view) { return true; });
  is_traced.set_value();
  is_flooded.get_future().wait();
  std::uint64_t kept = 0;
  std::uint64_t lost = 0;
  const auto count = [&](const wire::RawTrace& trace) {
    ++kept;
    lost += trace.lost;
  };
  hub.drain_traces(count);
  EXPECT_LT(kept, 1000U) << "room without bounds";
  EXPECT_EQ(lost, 0U);
  is_drained.set_value();
  script_.polled.get_future().wait();
  hub.drain_traces(count);
  EXPECT_EQ(kept + lost, 1001U) << "every message is accounted for";
}

TEST_F(SensorHubTest, ATraceThatBeginsAgainHasNothingOfTheOneBefore) {
  std::promise<void> is_traced;
  script_.first_poll = [&](const drivers::sensor::Clock&, drivers::sensor::Sink& sink) {
    is_traced.get_future().wait();
    sink.raw(drivers::sensor::RawDirection::kReceived, std::vector<std::uint8_t>{1});
  };
  SensorHub hub(config_, clock_, shared_gusts());
  hub.trace([](std::string_view) { return true; });
  is_traced.set_value();
  script_.polled.get_future().wait();
  hub.trace([](std::string_view) { return false; });
  hub.trace([](std::string_view) { return true; });
  int kept = 0;
  hub.drain_traces([&](const wire::RawTrace&) { ++kept; });
  EXPECT_EQ(kept, 0);
}

TEST_F(SensorHubTest, IsFinishedWhenEveryRecordingIs) {
  script_.first_poll = [](const drivers::sensor::Clock&, drivers::sensor::Sink& sink) {
    sink.link(wind::LinkState::kFinished, "the end");
  };
  const SensorHub hub(config_, clock_, shared_gusts());
  script_.polled.get_future().wait();
  EXPECT_TRUE(hub.is_finished());
}

TEST(SensorHub, ASensorThatCannotBeMadeIsAMistakeAtItsPlaceInTheFile) {
  const drivers::sensor::DriverDescription refusing{
      .name = "refusing",
      .summary = "",
      .parameters = {},
      .open = [](const ParameterValues&) -> std::unique_ptr<drivers::sensor::Sensor> {
        throw std::runtime_error("no such profile");
      }};
  try {
    settings::open_sensor(settings::default_sensor("roof", refusing, {}, "wall.toml:3:1"));
    FAIL() << "it was made";
  } catch (const settings::ConfigError& error) {
    EXPECT_STREQ(error.what(), "wall.toml:3:1: sensor: no such profile");
  }
}

}  // namespace
}  // namespace yuragi::daemon::sensing
