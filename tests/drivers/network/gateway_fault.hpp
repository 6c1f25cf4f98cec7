#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <utility>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/live_sensor.hpp"
#include "tests/support/simulator_thread.hpp"

namespace yuragi::drivers::network {

/// What a driver is held to under each fault: as it runs in the daemon, with a simulated gateway in a wind that never
/// changes.
class GatewayFault : public testing::Test {
 protected:
  static constexpr simulators::core::PlayedMoment kWind = {.speed_m_s = 7.3, .direction_deg = 123.0};

  /// `step_m_s`: of what the gateway can say.
  GatewayFault(std::unique_ptr<simulators::core::Simulator> simulator, std::unique_ptr<sensor::Sensor> sensor,
               double step_m_s)
      : step_m_s_(step_m_s), simulator_(std::move(simulator)), live_(std::move(sensor)) {}

  void SetUp() override { expect_return(); }

  /// It is well again and says the wind; what it said before is forgotten.
  void expect_return() {
    simulator_.set_fault({});
    // What was on its way when the fault ended comes first.
    ASSERT_TRUE(live_.wait_for_readings(1)) << live_.sink.last_detail();
    forget();
    ASSERT_TRUE(live_.wait_for_readings(3)) << live_.sink.last_detail();
    expect_only_the_wind();
    EXPECT_EQ(live_.sink.last_state(), wind::LinkState::kConnected) << live_.sink.last_detail();
    forget();
  }
  /// Suffers it until so much was refused and the status says so; meanwhile no wind is said.
  void expect_refusals(simulators::core::FaultKind fault, decode::Refusal why, const std::string& detail) {
    simulator_.set_fault(fault);
    ASSERT_TRUE(live_.wait_until([&] { return live_.sink.count(why) >= 1; })) << live_.sink.last_detail();
    live_.sink.readings.clear();  // of a message from before
    ASSERT_TRUE(live_.wait_until([&] {
      return live_.sink.count(why) >= 4 && live_.sink.last_detail().find(detail) != std::string::npos;
    })) << live_.sink.last_detail();
    EXPECT_THAT(live_.sink.readings, testing::IsEmpty());
    EXPECT_EQ(live_.sink.last_state(), wind::LinkState::kConnecting);
  }
  /// The driver publishes what the gateway says; the hub judges it.
  void expect_freeze_is_published() {
    simulator_.set_fault(simulators::core::FaultKind::kFreeze);
    ASSERT_TRUE(live_.wait_for_readings(5)) << live_.sink.last_detail();
    expect_only_the_wind();
    expect_return();
  }
  void expect_spike_is_not_believed() {
    ASSERT_TRUE(live_.wait_for_readings(20)) << "by which a spike is known";
    simulator_.set_fault(simulators::core::FaultKind::kSpike);
    ASSERT_TRUE(live_.wait_until(
        [&] { return !live_.sink.readings.empty() && live_.sink.readings.back().speed_m_s > 55.0 - 2.0 * step_m_s_; }));
    EXPECT_EQ(live_.sink.judge.fault(), wind::judging::ReadingFault::kSpike);
    for (const wind::Reading& believed : live_.sink.believed)
      EXPECT_NEAR(believed.speed_m_s, kWind.speed_m_s, step_m_s_);
  }
  void expect_pieces_are_joined() {
    simulator_.set_fault(simulators::core::FaultKind::kSplit);
    ASSERT_TRUE(live_.wait_for_readings(5)) << live_.sink.last_detail();
    expect_only_the_wind();
    EXPECT_THAT(live_.sink.refusals, testing::IsEmpty());
    expect_return();
  }
  void expect_only_the_wind() const {
    EXPECT_THAT(live_.sink.readings,
                testing::Each(testing::AllOf(
                    testing::Field(&wind::Reading::speed_m_s, testing::DoubleNear(kWind.speed_m_s, step_m_s_)),
                    testing::Field(&wind::Reading::direction_deg, testing::Optional(kWind.direction_deg)))));
  }
  void forget() {
    live_.sink.readings.clear();
    live_.sink.refusals.clear();
  }

 private:
  double step_m_s_;

 protected:
  SimulatorThread simulator_;
  test::LiveSensor live_;
};

}  // namespace yuragi::drivers::network
