// What a microcontroller that prints numbers can do wrong, and what the driver makes of it: with a simulator at the
// other end of a real wire. There is no checksum: what is cut, joined or garbled has to be noticed otherwise.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "drivers/text/line_sensor.hpp"
#include "simulators/text/line_device.hpp"
#include "tests/support/text_fault_bench.hpp"

namespace yuragi {
namespace {

using sim::FaultKind;
using testing::HasSubstr;

constexpr sim::PlayedMoment kLineWind = {.speed_m_s = 7.25, .direction_deg = 123.5};

class LineFault : public TextFaultBench {
 protected:
  LineFault() : TextFaultBench("line", kLineWind) {}

  void put(Wire wire, const std::string& format, double rate_hz, ParameterValues::Map given = {}) {
    connect(wire, sim::make_line_device(format), rate_hz, std::move(given),
            [](const ParameterValues& values, TextBench& bench) {
              const LineSensorSettings settings = line_sensor_settings_of(values);
              return std::make_unique<LineSensor>(settings, bench.port(settings.text.address));
            });
  }
  /// To the last digit: a cut number is nearly right.
  void expect_only_the_wind() override {
    for (const WindReading& reading : bench_.sink.readings) {
      EXPECT_EQ(reading.speed_m_s, kLineWind.speed_m_s);
      EXPECT_EQ(reading.direction_deg, kLineWind.direction_deg);
    }
  }
};

TEST_F(LineFault, Silence) {
  for (const Wire wire : {Wire::kPty, Wire::kTcp, Wire::kUdp}) {
    put(wire, "csv", 4.0);
    ASSERT_TRUE(is_live());
    bench_.run(1.0);
    bench_.run(3.5, FaultKind::kSilence);
    EXPECT_LE(bench_.sink.readings.size(), 1U) << "one may have been on its way";
    EXPECT_EQ(bench_.sink.last_state(), LinkState::kConnecting);
    EXPECT_THAT(bench_.sink.last_detail(), HasSubstr("is open, but says nothing"));
    bench_.run(5.0, FaultKind::kSilence);
    EXPECT_GE(bench_.sink.count(Refusal::kTimeout), 1) << bench_.sink.last_detail();
    EXPECT_TRUE(bench_.sink.readings.empty());
    expect_return();
  }
}

TEST_F(LineFault, Freeze) {
  put(Wire::kPty, "csv", 4.0);
  ASSERT_TRUE(is_live());
  bench_.run(5.0, FaultKind::kFreeze);
  EXPECT_GE(bench_.sink.readings.size(), 18U) << "the driver publishes what the device says; the hub judges it";
  EXPECT_EQ(bench_.sink.last_state(), LinkState::kConnected);
  expect_return();
}

TEST_F(LineFault, Spike) {
  put(Wire::kPty, "key-value", 4.0);
  ASSERT_TRUE(is_live());
  bench_.run(5.0);
  ASSERT_FALSE(bench_.sink.believed.empty());
  bench_.run(2.0, FaultKind::kSpike);
  EXPECT_NEAR(bench_.sink.readings.back().speed_m_s, 55.0, 0.01);
  EXPECT_EQ(bench_.sink.judge.fault(), ReadingFault::kSpike);
  EXPECT_THAT(bench_.sink.believed, testing::Each(testing::Field(&WindReading::speed_m_s, kLineWind.speed_m_s)))
      << "the hub keeps it from the wind";
  EXPECT_EQ(bench_.sink.last_state(), LinkState::kConnected);
  expect_return();
}

TEST_F(LineFault, Garbage) {
  for (const Wire wire : {Wire::kPty, Wire::kTcp, Wire::kUdp}) {
    for (const std::string format : {"csv", "key-value"}) {
      put(wire, format, 10.0);
      ASSERT_TRUE(is_live());
      bench_.run(wire == Wire::kPty ? 60.0 : 6.0, FaultKind::kGarbage);
      EXPECT_TRUE(bench_.sink.readings.empty()) << "among random bytes there are numbers, but no reading";
      EXPECT_FALSE(bench_.sink.refusals.empty());
      EXPECT_EQ(bench_.sink.last_state(), LinkState::kConnecting);
      EXPECT_THAT(bench_.sink.last_detail(), HasSubstr("but no line: check"));
      ASSERT_TRUE(is_live());
      bench_.run(1.0);  // what is not believed next to garbage
      expect_return();
    }
  }
}

TEST_F(LineFault, Split) {
  for (const Wire wire : {Wire::kPty, Wire::kTcp}) {
    for (const std::string format : {"csv", "key-value"}) {
      put(wire, format, 4.0);
      ASSERT_TRUE(is_live());
      bench_.run(5.0, FaultKind::kSplit);
      EXPECT_GE(bench_.sink.readings.size(), 18U);
      EXPECT_TRUE(bench_.sink.refusals.empty());
      expect_only_the_wind();
      expect_return();
    }
  }
}

TEST_F(LineFault, Partial) {
  for (const Wire wire : {Wire::kPty, Wire::kTcp}) {
    for (const std::string format : {"csv", "key-value"}) {
      for (const double rate_hz : {1.0, 4.0, 20.0}) {
        put(wire, format, rate_hz);
        ASSERT_TRUE(is_live());
        bench_.run(3.0 / rate_hz);
        bench_.run(12.0, FaultKind::kPartial);
        EXPECT_TRUE(bench_.sink.readings.empty());
        EXPECT_EQ(bench_.sink.last_state(), LinkState::kConnecting) << bench_.sink.last_detail();

        // The first line end after it belongs to what was cut.
        bench_.run(10.0);
        EXPECT_GE(static_cast<double>(bench_.sink.readings.size()), 6.0 * rate_hz);
        expect_only_the_wind();
        EXPECT_EQ(bench_.sink.last_state(), LinkState::kConnected);
      }
    }
  }
}

TEST_F(LineFault, Late) {
  put(Wire::kPty, "csv", 0.0, {{"request", std::string("?\n")}, {"poll_interval", 0.25}});
  ASSERT_TRUE(is_live());
  bench_.run(15.0, FaultKind::kLate);
  EXPECT_TRUE(bench_.sink.readings.empty()) << "an answer to an earlier question was taken for the one to this";
  EXPECT_GE(bench_.sink.count(Refusal::kTimeout), 2);
  EXPECT_GE(bench_.sink.count(Refusal::kNotMine), 2);
  EXPECT_EQ(bench_.sink.last_state(), LinkState::kConnecting);
  EXPECT_THAT(bench_.sink.last_detail(), HasSubstr("raise response_timeout"));
  ASSERT_TRUE(is_live());
  expect_return();
}

TEST_F(LineFault, Disconnect) {
  put(Wire::kTcp, "csv", 4.0);
  ASSERT_TRUE(is_live());
  expect_silence(FaultKind::kDisconnect, 5.0);
  EXPECT_THAT(bench_.sink.last_detail(), HasSubstr("cannot connect to 127.0.0.1:"));
  expect_return();
}

TEST_F(LineFault, Unplug) {
  for (const Wire wire : {Wire::kPty, Wire::kTcp, Wire::kUdp}) {
    put(wire, "csv", 4.0);
    ASSERT_TRUE(is_live());
    expect_silence(FaultKind::kUnplug, 6.0);
    expect_return();
  }
}

}  // namespace
}  // namespace yuragi
