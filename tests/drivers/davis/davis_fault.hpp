#pragma once

#include <memory>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/text_bench.hpp"

namespace yuragi::drivers::davis {

/// What the drivers of Davis devices are held to under each fault: on a bench with a simulated device, which measures a
/// wind that never changes.
class DavisFault : public testing::Test {
 protected:
  static constexpr double kSpeed_m_s = 16 * 0.44704;
  static constexpr double kDirection_deg = 123.0;

  static simulators::MeasuredWind still_wind() {
    return simulators::MeasuredWind(std::make_unique<StillWind>(
        simulators::PlayedMoment{.speed_m_s = kSpeed_m_s, .direction_deg = kDirection_deg}));
  }

  bool is_live() {
    bench_.sink.readings.clear();
    return bench_.run_until(60.0, {}, [this] {
      return bench_.sink.readings.size() >= 3 && bench_.sink.last_state() == wind::LinkState::kConnected;
    });
  }
  void expect_only_the_wind() const {
    for (const wind::WindReading& reading : bench_.sink.readings) {
      EXPECT_NEAR(reading.speed_m_s, kSpeed_m_s, 1e-9);
      EXPECT_EQ(reading.direction_deg, kDirection_deg);
    }
  }
  /// For so long; the status then says so, in such words.
  void expect_no_wind(simulators::FaultKind fault, double duration_s, const char* words) {
    bench_.run(duration_s, fault);
    EXPECT_TRUE(bench_.sink.readings.empty());
    EXPECT_EQ(bench_.sink.last_state(), wind::LinkState::kConnecting);
    EXPECT_THAT(bench_.sink.last_detail(), testing::HasSubstr(words));
  }
  /// The fault is over: the wind returns by itself, and nothing is refused any more.
  void expect_return() {
    ASSERT_TRUE(is_live()) << bench_.sink.last_detail();
    bench_.run(15.0);
    EXPECT_GE(bench_.sink.readings.size(), 5U);
    EXPECT_TRUE(bench_.sink.refusals.empty());
    expect_only_the_wind();
    EXPECT_EQ(bench_.sink.last_state(), wind::LinkState::kConnected);
  }

  /// Of a device that is connected: the driver publishes what it says, and the hub judges it.
  void expect_freeze_is_published() {
    ASSERT_TRUE(is_live());
    bench_.run(20.0, simulators::FaultKind::kFreeze);
    EXPECT_GE(bench_.sink.readings.size(), 7U);
    EXPECT_EQ(bench_.sink.last_state(), wind::LinkState::kConnected);
    expect_return();
  }
  void expect_spike_is_not_believed() {
    ASSERT_TRUE(is_live());
    bench_.run(60.0);
    ASSERT_FALSE(bench_.sink.believed.empty());
    bench_.run(5.0, simulators::FaultKind::kSpike);
    EXPECT_NEAR(bench_.sink.readings.back().speed_m_s, 55.0, 0.3);
    EXPECT_EQ(bench_.sink.judge.fault(), wind::judging::ReadingFault::kSpike);
    for (const wind::WindReading& believed : bench_.sink.believed) EXPECT_NEAR(believed.speed_m_s, kSpeed_m_s, 1e-9);
    expect_return();
  }
  /// Of the simulated station's other sensors.
  void expect_weather() const {
    ASSERT_FALSE(bench_.sink.station_quantities.empty());
    const wind::StationQuantities& said = bench_.sink.station_quantities.back();
    EXPECT_NEAR(said.air_temperature_c.value_or(0.0), 14.5, 1e-9);
    EXPECT_NEAR(said.pressure_hpa.value_or(0.0), 1013.24, 0.01);
    EXPECT_EQ(said.relative_humidity_percent, 65.0);
    EXPECT_NEAR(said.rain_rate_mm_h.value_or(0.0), 3.0, 1e-9);
    EXPECT_NEAR(said.rain_total_mm.value_or(0.0), 7.4, 1e-9);
  }

  TextBench bench_;
};

}  // namespace yuragi::drivers::davis
