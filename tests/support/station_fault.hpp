#pragma once

#include <memory>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/text_bench.hpp"

namespace yuragi {

/// What the driver of a weather station is held to under each fault: on a bench with a simulated one, which measures a
/// wind that never changes.
class StationFault : public testing::Test {
 protected:
  /// `speed_m_s`: of the wind, one that the station can say; `interval_s`: between two of its readings.
  StationFault(double speed_m_s, double interval_s) : speed_m_s_(speed_m_s), interval_s_(interval_s) {}

  simulators::core::MeasuredWind still_wind() const {
    return simulators::core::MeasuredWind(std::make_unique<StillWind>(
        simulators::core::PlayedMoment{.speed_m_s = speed_m_s_, .direction_deg = kDirection_deg}));
  }

  bool is_live() {
    bench_.sink.readings.clear();
    return bench_.run_until(24.0 * interval_s_, {}, [this] {
      return bench_.sink.readings.size() >= 3 && bench_.sink.last_state() == wind::LinkState::kConnected;
    });
  }
  void expect_only_the_wind() const {
    for (const wind::Reading& reading : bench_.sink.readings) {
      EXPECT_NEAR(reading.speed_m_s, speed_m_s_, 1e-9);
      EXPECT_EQ(reading.direction_deg, kDirection_deg);
    }
  }
  /// For so long; the status then says so, in such words.
  void expect_no_wind(simulators::core::FaultKind fault, double duration_s, const char* words) {
    bench_.run(duration_s, fault);
    EXPECT_TRUE(bench_.sink.readings.empty());
    EXPECT_EQ(bench_.sink.last_state(), wind::LinkState::kConnecting);
    EXPECT_THAT(bench_.sink.last_detail(), testing::HasSubstr(words));
  }
  /// The fault is over: the wind returns by itself, and nothing is refused any more.
  void expect_return() {
    ASSERT_TRUE(is_live()) << bench_.sink.last_detail();
    bench_.run(6.0 * interval_s_);
    EXPECT_GE(bench_.sink.readings.size(), 5U);
    EXPECT_TRUE(bench_.sink.refusals.empty());
    expect_only_the_wind();
    EXPECT_EQ(bench_.sink.last_state(), wind::LinkState::kConnected);
  }

  /// Of a device that is connected: the driver publishes what it says, and the hub judges it.
  void expect_freeze_is_published() {
    ASSERT_TRUE(is_live());
    bench_.run(8.0 * interval_s_, simulators::core::FaultKind::kFreeze);
    EXPECT_GE(bench_.sink.readings.size(), 7U);
    EXPECT_EQ(bench_.sink.last_state(), wind::LinkState::kConnected);
    expect_return();
  }
  void expect_spike_is_not_believed() {
    ASSERT_TRUE(is_live());
    bench_.run(24.0 * interval_s_);
    ASSERT_FALSE(bench_.sink.believed.empty());
    bench_.run(2.0 * interval_s_, simulators::core::FaultKind::kSpike);
    EXPECT_NEAR(bench_.sink.readings.back().speed_m_s, 55.0, 0.3);
    EXPECT_EQ(bench_.sink.judge.fault(), wind::judging::ReadingFault::kSpike);
    for (const wind::Reading& believed : bench_.sink.believed) EXPECT_NEAR(believed.speed_m_s, speed_m_s_, 1e-9);
    expect_return();
  }
  static constexpr double kDirection_deg = 123.0;
  TextBench bench_;

 private:
  double speed_m_s_;
  double interval_s_;
};

}  // namespace yuragi
