// What an anemometer can do wrong, and what the driver makes of it: with a simulator at the other end of a real wire.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "drivers/nmea_sensor.hpp"
#include "simulators/nmea_device.hpp"
#include "tests/support/driver_named.hpp"
#include "tests/support/free_port.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/support/text_bench.hpp"

namespace yuragi {
namespace {

using sim::FaultKind;
using testing::HasSubstr;

constexpr sim::PlayedMoment kWind = {.speed_m_s = 7.0, .direction_deg = 123.0};

class NmeaFault : public testing::Test {
 protected:
  enum class Wire { kPty, kTcp, kUdp };

  void put(Wire wire, const std::vector<std::string>& formats, double rate_hz, ParameterValues::Map given = {}) {
    bench_.put(nullptr, nullptr);  // the name of the port is free again
    auto carried = wire == Wire::kPty   ? sim::make_pty_wire((folder_ / "anemometer").string())
                   : wire == Wire::kTcp ? sim::make_tcp_wire("127.0.0.1", 0)
                                        : sim::make_udp_wire("127.0.0.1", udp_port_);
    const std::string place = carried->place();
    if (wire == Wire::kPty) {
      given["device"] = (folder_ / "anemometer").string();
    } else {
      given["transport"] = std::string(wire == Wire::kTcp ? "tcp" : "udp");
      given["host"] = std::string("127.0.0.1");
      given["port"] = std::int64_t{std::stoi(place.substr(place.rfind(':') + 1))};
    }
    const NmeaSensorSettings settings = nmea_sensor_settings_of(values_for("nmea", given));
    bench_.put(std::make_unique<sim::TextSimulator>(sim::make_nmea_device(formats), bench_.told(std::move(carried)),
                                                    rate_hz, sim::MeasuredWind(std::make_unique<StillWind>(kWind)), 1),
               std::make_unique<NmeaSensor>(settings, bench_.port(settings.text.address)));
  }

  bool is_live(double limit_s = 15.0) {
    bench_.sink.readings.clear();
    return bench_.run_until(limit_s, {}, [this] {
      return !bench_.sink.readings.empty() && bench_.sink.last_state() == LinkState::kConnected;
    });
  }
  /// Every reading that came is the wind.
  void expect_only_the_wind() {
    for (const WindReading& reading : bench_.sink.readings) {
      EXPECT_NEAR(reading.speed_m_s, kWind.speed_m_s, 0.06);
      ASSERT_TRUE(reading.direction_deg.has_value());
      EXPECT_NEAR(*reading.direction_deg, kWind.direction_deg, 0.6);
    }
  }
  void expect_return() {
    ASSERT_TRUE(is_live()) << bench_.sink.last_detail();
    bench_.run(2.0);
    EXPECT_GE(bench_.sink.readings.size(), 5U);
    EXPECT_TRUE(bench_.sink.refusals.empty());
    expect_only_the_wind();
  }

  const std::uint16_t udp_port_ = free_port(SOCK_DGRAM);
  test::TemporaryFolder folder_;
  TextBench bench_;
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
  bench_.run(5.0, FaultKind::kDisconnect);
  EXPECT_TRUE(bench_.sink.readings.empty());
  EXPECT_EQ(bench_.sink.last_state(), LinkState::kConnecting);
  EXPECT_THAT(bench_.sink.last_detail(), HasSubstr("cannot connect to 127.0.0.1:"));
  expect_return();
}

TEST_F(NmeaFault, Unplug) {
  for (const Wire wire : {Wire::kPty, Wire::kTcp, Wire::kUdp}) {
    put(wire, {"mwv"}, 4.0);
    ASSERT_TRUE(is_live());
    bench_.run(6.0, FaultKind::kUnplug);
    EXPECT_TRUE(bench_.sink.readings.empty());
    EXPECT_EQ(bench_.sink.last_state(), LinkState::kConnecting);
    if (wire == Wire::kPty) {
      EXPECT_THAT(bench_.sink.last_detail(), HasSubstr("check that it is plugged in"));
    }
    expect_return();
  }
}

}  // namespace
}  // namespace yuragi
