// What a Davis console and its line can do wrong, and what the driver makes of it: with a simulated console at the
// other end of a real pseudo terminal or TCP connection.
#include <cmath>
#include <memory>
#include <string>
#include <utility>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "drivers/davis/vantage_sensor.hpp"
#include "simulators/davis/vantage_console.hpp"
#include "tests/support/driver_named.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/support/text_bench.hpp"

namespace yuragi::drivers::davis {
namespace {

using simulators::FaultKind;
using simulators::davis::VantageConsole;
using simulators::davis::VantageConsoleOptions;
using testing::HasSubstr;

constexpr double kMetresPerSecondOf16Mph = 16 * 0.44704;

class VantageFault : public testing::Test {
 protected:
  enum class Wire { kPty, kTcp };

  void connect(Wire wire, const VantageConsoleOptions& options = {}) {
    bench_.put(nullptr, nullptr);  // the name of the port is free again
    const std::string link = (folder_ / "console").string();
    auto carried =
        wire == Wire::kPty ? simulators::text::make_pty_wire(link) : simulators::text::make_tcp_wire("127.0.0.1", 0);
    const std::string place = carried->place();
    ParameterValues::Map given = {{"device", link}};
    if (wire == Wire::kTcp) {
      given = {{"transport", std::string("tcp")},
               {"host", std::string("127.0.0.1")},
               {"port", std::int64_t{std::stoi(place.substr(place.rfind(':') + 1))}}};
    }
    auto console =
        std::make_unique<VantageConsole>(bench_.observed(std::move(carried)), options,
                                         simulators::MeasuredWind(std::make_unique<StillWind>(simulators::PlayedMoment{
                                             .speed_m_s = kMetresPerSecondOf16Mph, .direction_deg = 123.0})));
    console_ = console.get();
    const VantageSettings settings = vantage_settings_of(values_for("davis", given));
    bench_.put(std::move(console), std::make_unique<VantageSensor>(settings, bench_.port(settings.address)));
  }

  bool is_live(double limit_s = 40.0) {
    bench_.sink.readings.clear();
    return bench_.run_until(limit_s, {}, [this] {
      return !bench_.sink.readings.empty() && bench_.sink.last_state() == wind::LinkState::kConnected;
    });
  }
  void expect_only_the_wind() {
    for (const wind::WindReading& reading : bench_.sink.readings) {
      EXPECT_NEAR(reading.speed_m_s, kMetresPerSecondOf16Mph, 1e-9);
      ASSERT_TRUE(reading.direction_deg.has_value());
      EXPECT_EQ(*reading.direction_deg, 123.0);
    }
  }
  void expect_return() {
    ASSERT_TRUE(is_live()) << bench_.sink.last_detail();
    bench_.run(10.0);
    EXPECT_GE(bench_.sink.readings.size(), 3U);
    EXPECT_TRUE(bench_.sink.refusals.empty());
    expect_only_the_wind();
  }

  TextBench bench_;
  VantageConsole* console_ = nullptr;

 private:
  test::TemporaryFolder folder_;
};

/// Through the end of the first packets that it was asked for, and of the second.
TEST_F(VantageFault, WithoutAnyNothingIsLost) {
  for (const Wire wire : {Wire::kPty, Wire::kTcp}) {
    const bool knows_lps = wire == Wire::kPty;
    connect(wire, {.interval_s = 0.25, .knows_lps = knows_lps});
    ASSERT_TRUE(is_live()) << bench_.sink.last_detail();
    bench_.run(110.0);
    EXPECT_GE(bench_.sink.readings.size(), 430U) << "a packet every 0.25 s, but while it is asked again";
    EXPECT_TRUE(bench_.sink.refusals.empty());
    expect_only_the_wind();
    EXPECT_EQ(bench_.sink.readings.back().gust_m_s.has_value(), knows_lps);
    const wind::StationQuantities& said = bench_.sink.station_quantities.back();
    EXPECT_NEAR(said.air_temperature_c.value_or(0.0), 14.5, 1e-9);
    EXPECT_NEAR(said.pressure_hpa.value_or(0.0), 1013.24, 0.01);
    EXPECT_EQ(said.relative_humidity_percent, 65.0);
    EXPECT_NEAR(said.rain_rate_mm_h.value_or(0.0), 3.0, 1e-9);
    EXPECT_NEAR(said.rain_total_mm.value_or(0.0), 7.4, 1e-9);
  }
}

TEST_F(VantageFault, WithoutAnyTheConsoleIsLeftAsleep) {
  connect(Wire::kTcp);  // a pseudo terminal loses what has not been read when it is closed
  ASSERT_TRUE(is_live());
  EXPECT_GT(console_->packets_left(), 0);
  bench_.close_sensor();
  EXPECT_EQ(console_->packets_left(), 0) << "it was told to end";
}

TEST_F(VantageFault, Silence) {
  for (const Wire wire : {Wire::kPty, Wire::kTcp}) {
    connect(wire);
    ASSERT_TRUE(is_live()) << bench_.sink.last_detail();
    bench_.run(1.0);
    bench_.run(6.0, FaultKind::kSilence);
    EXPECT_TRUE(bench_.sink.readings.empty());
    EXPECT_EQ(bench_.sink.last_state(), wind::LinkState::kConnecting);
    EXPECT_THAT(bench_.sink.last_detail(), HasSubstr("is silent: check its power"));
    bench_.run(10.0, FaultKind::kSilence);
    EXPECT_GE(bench_.sink.count(decode::Refusal::kTimeout), 3);
    EXPECT_THAT(bench_.sink.last_detail(), HasSubstr("does not wake up"));
    expect_return();
  }
}

TEST_F(VantageFault, Freeze) {
  connect(Wire::kPty);
  ASSERT_TRUE(is_live());
  bench_.run(20.0, FaultKind::kFreeze);
  EXPECT_GE(bench_.sink.readings.size(), 7U) << "the driver publishes what the console says; the hub judges it";
  EXPECT_EQ(bench_.sink.last_state(), wind::LinkState::kConnected);
  expect_return();
}

TEST_F(VantageFault, Spike) {
  connect(Wire::kPty);
  ASSERT_TRUE(is_live());
  bench_.run(60.0);
  ASSERT_FALSE(bench_.sink.believed.empty());
  bench_.run(5.0, FaultKind::kSpike);
  EXPECT_NEAR(bench_.sink.readings.back().speed_m_s, 55.0, 0.3);
  EXPECT_EQ(bench_.sink.judge.fault(), wind::judging::ReadingFault::kSpike);
  for (const wind::WindReading& believed : bench_.sink.believed) {
    EXPECT_NEAR(believed.speed_m_s, kMetresPerSecondOf16Mph, 1e-9) << "the hub keeps it from the wind";
  }
  expect_return();
}

TEST_F(VantageFault, Garbage) {
  for (const Wire wire : {Wire::kPty, Wire::kTcp}) {
    connect(wire);
    ASSERT_TRUE(is_live());
    bench_.run(25.0, FaultKind::kGarbage);
    EXPECT_TRUE(bench_.sink.readings.empty());
    EXPECT_GE(bench_.sink.count(decode::Refusal::kMalformed), 5);
    EXPECT_EQ(bench_.sink.last_state(), wind::LinkState::kConnecting);
    EXPECT_THAT(bench_.sink.last_detail(), HasSubstr("packets arrive damaged"));
    expect_return();
  }
}

TEST_F(VantageFault, Split) {
  for (const Wire wire : {Wire::kPty, Wire::kTcp}) {
    connect(wire);
    ASSERT_TRUE(is_live());
    bench_.run(20.0, FaultKind::kSplit);
    EXPECT_GE(bench_.sink.readings.size(), 7U);
    EXPECT_TRUE(bench_.sink.refusals.empty());
    expect_only_the_wind();
    expect_return();
  }
}

TEST_F(VantageFault, Partial) {
  for (const Wire wire : {Wire::kPty, Wire::kTcp}) {
    connect(wire);
    ASSERT_TRUE(is_live());
    bench_.run(30.0, FaultKind::kPartial);
    EXPECT_TRUE(bench_.sink.readings.empty());
    EXPECT_GE(bench_.sink.count(decode::Refusal::kTooShort), 4);
    EXPECT_EQ(bench_.sink.last_state(), wind::LinkState::kConnecting);
    EXPECT_THAT(bench_.sink.last_detail(), HasSubstr("packets arrive damaged"));
    ASSERT_TRUE(is_live());
    expect_return();
  }
}

TEST_F(VantageFault, BadChecksum) {
  for (const Wire wire : {Wire::kPty, Wire::kTcp}) {
    connect(wire);
    ASSERT_TRUE(is_live());
    bench_.run(30.0, FaultKind::kBadChecksum);
    EXPECT_TRUE(bench_.sink.readings.empty());
    EXPECT_GE(bench_.sink.count(decode::Refusal::kBadChecksum), 6);
    EXPECT_EQ(bench_.sink.last_state(), wind::LinkState::kConnecting);
    EXPECT_THAT(bench_.sink.last_detail(), HasSubstr("packets arrive damaged"));
    expect_return();
  }
}

TEST_F(VantageFault, Late) {
  connect(Wire::kPty);
  bench_.run(60.0, FaultKind::kLate);
  EXPECT_GE(bench_.sink.count(decode::Refusal::kTimeout), 2);
  expect_only_the_wind();  // a packet is no answer to one question alone: late, it is still the wind
  ASSERT_TRUE(is_live()) << bench_.sink.last_detail();
  bench_.run(5.0);
  expect_return();
}

TEST_F(VantageFault, Exception) {
  connect(Wire::kPty);
  bench_.run(10.0, FaultKind::kException);
  EXPECT_TRUE(bench_.sink.readings.empty());
  EXPECT_GE(bench_.sink.count(decode::Refusal::kException), 4);
  EXPECT_THAT(bench_.sink.last_detail(), HasSubstr("check that it is a Davis console"));
  expect_return();
}

TEST_F(VantageFault, Disconnect) {
  connect(Wire::kTcp);
  ASSERT_TRUE(is_live());
  bench_.run(5.0, FaultKind::kDisconnect);
  EXPECT_TRUE(bench_.sink.readings.empty());
  EXPECT_EQ(bench_.sink.last_state(), wind::LinkState::kConnecting);
  EXPECT_THAT(bench_.sink.last_detail(), HasSubstr("cannot connect to 127.0.0.1:"));
  expect_return();
}

TEST_F(VantageFault, Unplug) {
  for (const Wire wire : {Wire::kPty, Wire::kTcp}) {
    connect(wire);
    ASSERT_TRUE(is_live());
    bench_.run(6.0, FaultKind::kUnplug);
    EXPECT_TRUE(bench_.sink.readings.empty());
    EXPECT_EQ(bench_.sink.last_state(), wind::LinkState::kConnecting);
    expect_return();
  }
}

}  // namespace
}  // namespace yuragi::drivers::davis
