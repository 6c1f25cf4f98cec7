// What a microcontroller that prints numbers can do wrong, and what the driver makes of it: with a simulator at the
// other end of a real wire. There is no checksum: what is cut, joined or garbled has to be noticed otherwise.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "drivers/line_sensor.hpp"
#include "simulators/line_device.hpp"
#include "tests/support/driver_named.hpp"
#include "tests/support/free_port.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/support/text_bench.hpp"

namespace yuragi {
namespace {

using sim::FaultKind;
using testing::HasSubstr;

constexpr sim::PlayedMoment kLineWind = {.speed_m_s = 7.25, .direction_deg = 123.5};

class LineFault : public testing::Test {
 protected:
  enum class Wire { kPty, kTcp, kUdp };

  void put(Wire wire, const std::string& format, double rate_hz, ParameterValues::Map given = {}) {
    bench_.put(nullptr, nullptr);  // the name of the port is free again
    auto carried = wire == Wire::kPty   ? sim::make_pty_wire((folder_ / "arduino").string())
                   : wire == Wire::kTcp ? sim::make_tcp_wire("127.0.0.1", 0)
                                        : sim::make_udp_wire("127.0.0.1", udp_port_);
    const std::string place = carried->place();
    if (wire == Wire::kPty) {
      given["device"] = (folder_ / "arduino").string();
    } else {
      given["transport"] = std::string(wire == Wire::kTcp ? "tcp" : "udp");
      given["host"] = std::string("127.0.0.1");
      given["port"] = std::int64_t{std::stoi(place.substr(place.rfind(':') + 1))};
    }
    const LineSensorSettings settings = line_sensor_settings_of(values_for("line", given));
    bench_.put(
        std::make_unique<sim::TextSimulator>(sim::make_line_device(format), bench_.told(std::move(carried)), rate_hz,
                                             sim::MeasuredWind(std::make_unique<StillWind>(kLineWind)), 1),
        std::make_unique<LineSensor>(settings, bench_.port(settings.text.address)));
  }

  bool is_live(double limit_s = 20.0) {
    bench_.sink.readings.clear();
    return bench_.run_until(limit_s, {}, [this] {
      return !bench_.sink.readings.empty() && bench_.sink.last_state() == LinkState::kConnected;
    });
  }
  /// Every reading that came is the wind, to the last digit: a cut number is nearly right.
  void expect_only_the_wind() {
    for (const WindReading& reading : bench_.sink.readings) {
      EXPECT_EQ(reading.speed_m_s, kLineWind.speed_m_s);
      EXPECT_EQ(reading.direction_deg, kLineWind.direction_deg);
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
  bench_.run(2.0, FaultKind::kSpike);
  EXPECT_NEAR(bench_.sink.readings.back().speed_m_s, 55.0, 0.01);
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
  bench_.run(5.0, FaultKind::kDisconnect);
  EXPECT_TRUE(bench_.sink.readings.empty());
  EXPECT_EQ(bench_.sink.last_state(), LinkState::kConnecting);
  EXPECT_THAT(bench_.sink.last_detail(), HasSubstr("cannot connect to 127.0.0.1:"));
  expect_return();
}

TEST_F(LineFault, Unplug) {
  for (const Wire wire : {Wire::kPty, Wire::kTcp, Wire::kUdp}) {
    put(wire, "csv", 4.0);
    ASSERT_TRUE(is_live());
    bench_.run(6.0, FaultKind::kUnplug);
    EXPECT_TRUE(bench_.sink.readings.empty());
    EXPECT_EQ(bench_.sink.last_state(), LinkState::kConnecting);
    expect_return();
  }
}

}  // namespace
}  // namespace yuragi
