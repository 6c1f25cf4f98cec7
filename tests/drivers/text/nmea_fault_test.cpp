// What an anemometer can do wrong, and what the driver makes of it: with a simulator at the other end of a real wire.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "drivers/text/nmea_sensor.hpp"
#include "simulators/text/nmea_device.hpp"
#include "tests/support/text_fault_bench.hpp"

namespace yuragi {
namespace {

using sim::FaultKind;
using testing::HasSubstr;

constexpr sim::PlayedMoment kWind = {.speed_m_s = 7.0, .direction_deg = 123.0};

class NmeaFault : public TextFaultBench {
 protected:
  NmeaFault() : TextFaultBench("nmea", kWind) {}

  void put(Wire wire, const std::vector<std::string>& formats, double rate_hz, ParameterValues::Map given = {}) {
    connect(wire, sim::make_nmea_device(formats), rate_hz, std::move(given),
            [](const ParameterValues& values, TextBench& bench) {
              const NmeaSensorSettings settings = nmea_sensor_settings_of(values);
              return std::make_unique<NmeaSensor>(settings, bench.port(settings.text.address));
            });
  }
  void expect_only_the_wind() override {
    for (const WindReading& reading : bench_.sink.readings) {
      EXPECT_NEAR(reading.speed_m_s, kWind.speed_m_s, 0.06);
      ASSERT_TRUE(reading.direction_deg.has_value());
      EXPECT_NEAR(*reading.direction_deg, kWind.direction_deg, 0.6);
    }
  }
};

TEST_F(NmeaFault, Silence) {
  for (const Wire wire : {Wire::kPty, Wire::kTcp, Wire::kUdp}) {
    put(wire, {"mwv"}, 4.0);
    ASSERT_TRUE(is_live());
    bench_.run(1.0);
    bench_.run(3.5, FaultKind::kSilence);
    EXPECT_LE(bench_.sink.readings.size(), 1U) << "one may have been on its way";
    EXPECT_EQ(bench_.sink.last_state(), LinkState::kConnecting);
    EXPECT_THAT(bench_.sink.last_detail(), HasSubstr("is open, but says nothing"));

    // At some time the port itself is doubted, and opened again.
    bench_.run(5.0, FaultKind::kSilence);
    EXPECT_GE(bench_.sink.count(Refusal::kTimeout), 1) << bench_.sink.last_detail();
    EXPECT_TRUE(bench_.sink.readings.empty());
    expect_return();
  }
}

TEST_F(NmeaFault, Freeze) {
  put(Wire::kPty, {"mwv"}, 4.0);
  ASSERT_TRUE(is_live());
  bench_.run(5.0, FaultKind::kFreeze);
  EXPECT_GE(bench_.sink.readings.size(), 18U) << "the driver publishes what the device says; the hub judges it";
  EXPECT_EQ(bench_.sink.last_state(), LinkState::kConnected);
  expect_return();
}

TEST_F(NmeaFault, Spike) {
  put(Wire::kPty, {"gill"}, 4.0);
  ASSERT_TRUE(is_live());
  bench_.run(2.0, FaultKind::kSpike);
  EXPECT_NEAR(bench_.sink.readings.back().speed_m_s, 55.0, 0.01);
  EXPECT_EQ(bench_.sink.last_state(), LinkState::kConnected);
  expect_return();
}

TEST_F(NmeaFault, Garbage) {
  for (const Wire wire : {Wire::kPty, Wire::kTcp, Wire::kUdp}) {
    put(wire, {"mwv"}, 10.0);
    ASSERT_TRUE(is_live());
    bench_.run(10.0, FaultKind::kGarbage);
    EXPECT_TRUE(bench_.sink.readings.empty());
    EXPECT_FALSE(bench_.sink.refusals.empty());
    EXPECT_EQ(bench_.sink.last_state(), LinkState::kConnecting);
    EXPECT_THAT(bench_.sink.last_detail(), HasSubstr("but no line: check"));
    if (wire == Wire::kPty) {
      EXPECT_THAT(bench_.sink.last_detail(), HasSubstr("baud"));
    }
    // The first line after it may have some of it in front.
    ASSERT_TRUE(is_live());
    expect_return();
  }
}

TEST_F(NmeaFault, Split) {
  for (const Wire wire : {Wire::kPty, Wire::kTcp}) {
    for (const std::string format : {"mwv", "gill", "ft"}) {
      put(wire, {format}, 4.0);
      ASSERT_TRUE(is_live());
      bench_.run(5.0, FaultKind::kSplit);
      EXPECT_GE(bench_.sink.readings.size(), 18U);
      EXPECT_TRUE(bench_.sink.refusals.empty());
      expect_only_the_wind();
      EXPECT_EQ(bench_.sink.last_state(), LinkState::kConnected);
      expect_return();
    }
  }
}

TEST_F(NmeaFault, Partial) {
  for (const Wire wire : {Wire::kPty, Wire::kTcp, Wire::kUdp}) {
    for (const std::string format : {"mwv", "gill"}) {
      put(wire, {format}, 4.0);
      ASSERT_TRUE(is_live());
      bench_.run(10.0, FaultKind::kPartial);
      EXPECT_TRUE(bench_.sink.readings.empty());
      EXPECT_FALSE(bench_.sink.refusals.empty());
      EXPECT_EQ(bench_.sink.last_state(), LinkState::kConnecting) << bench_.sink.last_detail();
      ASSERT_TRUE(is_live());
      expect_return();
    }
  }
}

TEST_F(NmeaFault, BadChecksum) {
  for (const std::string format : {"mwv", "mwd", "xdr", "gill", "gill-uv", "ft"}) {
    put(Wire::kPty, {format}, 4.0);
    ASSERT_TRUE(is_live());
    bench_.run(5.0, FaultKind::kBadChecksum);
    EXPECT_TRUE(bench_.sink.readings.empty());
    EXPECT_GE(bench_.sink.count(Refusal::kBadChecksum), 18);
    EXPECT_EQ(bench_.sink.last_state(), LinkState::kConnecting);
    EXPECT_THAT(bench_.sink.last_detail(), HasSubstr("wrong checksums: check its cable and baud"));
    expect_return();
  }
}

TEST_F(NmeaFault, WrongId) {
  const std::vector<std::pair<std::string, std::string>> talkers = {{"mwv", "WI"}, {"gill", "Q"}, {"ft", "WI"}};
  for (const auto& [format, talker] : talkers) {
    put(Wire::kPty, {format}, 4.0, {{"talker", talker}});
    ASSERT_TRUE(is_live());
    bench_.run(5.0, FaultKind::kWrongId);
    EXPECT_TRUE(bench_.sink.readings.empty());
    EXPECT_GE(bench_.sink.count(Refusal::kNotMine), 18);
    EXPECT_EQ(bench_.sink.last_state(), LinkState::kConnecting);
    EXPECT_THAT(bench_.sink.last_detail(), HasSubstr("talker"));
    expect_return();
  }
}

TEST_F(NmeaFault, Late) {
  for (const auto& [format, driver_format] : {std::pair("umb", "umb"), std::pair("ft", "ft")}) {
    put(Wire::kPty, {format}, 0.0, {{"format", std::string(driver_format)}, {"poll_interval", 0.25}});
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
}

TEST_F(NmeaFault, Disconnect) {
  put(Wire::kTcp, {"mwv"}, 4.0);
  ASSERT_TRUE(is_live());
  expect_silence(FaultKind::kDisconnect, 5.0);
  EXPECT_THAT(bench_.sink.last_detail(), HasSubstr("cannot connect to 127.0.0.1:"));
  expect_return();
}

TEST_F(NmeaFault, Unplug) {
  for (const Wire wire : {Wire::kPty, Wire::kTcp, Wire::kUdp}) {
    put(wire, {"mwv"}, 4.0);
    ASSERT_TRUE(is_live());
    expect_silence(FaultKind::kUnplug, 6.0);
    if (wire == Wire::kPty) {
      EXPECT_THAT(bench_.sink.last_detail(), HasSubstr("check that it is plugged in"));
    }
    expect_return();
  }
}

}  // namespace
}  // namespace yuragi
