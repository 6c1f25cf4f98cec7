// What can go wrong with a gateway to an NMEA 2000 bus and with a Signal K server, and what their drivers make of it:
// with a simulator at the other end of a real wire.
#include <array>
#include <cerrno>
#include <cmath>
#include <string>
#include <utility>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include "drivers/bus/can_socket.hpp"
#include "drivers/text/nmea2000_sensor.hpp"
#include "drivers/text/signalk_sensor.hpp"
#include "simulators/text/nmea2000_device.hpp"
#include "simulators/text/signalk_device.hpp"
#include "tests/support/text_fault_bench.hpp"

namespace yuragi::drivers::text {
namespace {

using simulators::core::FaultKind;
using testing::HasSubstr;
using Wire = TextFaultBench::Wire;

constexpr simulators::core::PlayedMoment kWind = {.speed_m_s = 7.25, .direction_deg = 123.0};

/// What both drivers suffer.
class MarineBench : public TextFaultBench {
 protected:
  explicit MarineBench(std::string driver) : TextFaultBench(std::move(driver), kWind) {}

  void expect_only_the_wind() override {
    for (const wind::Reading& reading : bench_.sink.readings) {
      EXPECT_NEAR(reading.speed_m_s, kWind.speed_m_s, 0.006);
      ASSERT_TRUE(reading.direction_deg.has_value());
      EXPECT_NEAR(*reading.direction_deg, kWind.direction_deg, 0.06);
    }
  }
  void expect_silence_is_told() {
    bench_.run(1.0);
    bench_.run(3.5, FaultKind::kSilence);
    EXPECT_LE(bench_.sink.readings.size(), 1U) << "one may have been on its way";
    EXPECT_EQ(bench_.sink.last_state(), wind::LinkState::kConnecting);
    EXPECT_THAT(bench_.sink.last_detail(), HasSubstr("is open, but silent"));
    bench_.run(5.0, FaultKind::kSilence);
    EXPECT_GE(bench_.sink.count(decode::Refusal::kTimeout), 1) << bench_.sink.last_detail();
    EXPECT_TRUE(bench_.sink.readings.empty());
    expect_return();
  }
  void expect_freeze_is_published() {
    bench_.run(5.0, FaultKind::kFreeze);
    EXPECT_GE(bench_.sink.readings.size(), 18U) << "the driver publishes what the device says; the hub judges it";
    EXPECT_EQ(bench_.sink.last_state(), wind::LinkState::kConnected);
    expect_return();
  }
  void expect_spike_is_not_believed() {
    bench_.run(5.0);
    ASSERT_FALSE(bench_.sink.believed.empty());
    bench_.run(2.0, FaultKind::kSpike);
    EXPECT_EQ(bench_.sink.judge.fault(), wind::judging::ReadingFault::kSpike);
    for (const wind::Reading& believed : bench_.sink.believed) EXPECT_NEAR(believed.speed_m_s, 7.25, 0.006);
    expect_return();
  }
  void expect_garbage_is_refused() {
    bench_.run(10.0, FaultKind::kGarbage);
    EXPECT_TRUE(bench_.sink.readings.empty());
    EXPECT_FALSE(bench_.sink.refusals.empty());
    EXPECT_EQ(bench_.sink.last_state(), wind::LinkState::kConnecting);
    EXPECT_THAT(bench_.sink.last_detail(), HasSubstr("but no lines: check"));
    ASSERT_TRUE(is_live());
    expect_return();
  }
  void expect_pieces_are_joined() {
    bench_.run(5.0, FaultKind::kSplit);
    EXPECT_GE(bench_.sink.readings.size(), 18U);
    EXPECT_TRUE(bench_.sink.refusals.empty());
    expect_only_the_wind();
    expect_return();
  }
  void expect_parts_are_refused(Wire wire) {
    bench_.run(0.75);
    bench_.run(12.0, FaultKind::kPartial);
    EXPECT_TRUE(bench_.sink.readings.empty());
    EXPECT_EQ(bench_.sink.refusals.empty(), wire != Wire::kUdp) << "a datagram ends by itself, a line by its end";
    EXPECT_EQ(bench_.sink.last_state(), wind::LinkState::kConnecting) << bench_.sink.last_detail();
    bench_.run(2.0);
    EXPECT_EQ(bench_.sink.count(decode::Refusal::kMalformed), wire == Wire::kUdp ? 0 : 1)
        << "the first end of a line belongs to what was cut";
    expect_only_the_wind();
    expect_return();
  }
  void expect_another_is_not_taken(const std::string& key) {
    bench_.run(5.0, FaultKind::kWrongId);
    EXPECT_TRUE(bench_.sink.readings.empty());
    EXPECT_GE(bench_.sink.count(decode::Refusal::kNotMine), 18);
    EXPECT_EQ(bench_.sink.last_state(), wind::LinkState::kConnecting);
    EXPECT_THAT(bench_.sink.last_detail(), HasSubstr(key));
    expect_return();
  }
};

class Nmea2000Fault : public MarineBench {
 protected:
  Nmea2000Fault() : MarineBench("nmea2000") {}

  void put(Wire wire, const std::string& format, ParameterValues::Map given = {}) {
    connect(wire, simulators::text::make_nmea2000_device(format), 4.0, std::move(given),
            [](const ParameterValues& values, TextBench& bench) -> std::unique_ptr<sensor::Sensor> {
              const Nmea2000SensorSettings settings = nmea2000_sensor_settings_of(values);
              return std::make_unique<Nmea2000Sensor>(settings, bench.port(settings.text.address));
            });
    ASSERT_TRUE(is_live()) << bench_.sink.last_detail();
    expect_only_the_wind();
  }
};

TEST_F(Nmea2000Fault, Silence) {
  for (const Wire wire : {Wire::kPty, Wire::kTcp, Wire::kUdp}) {
    put(wire, "yacht-devices");
    expect_silence_is_told();
  }
}
TEST_F(Nmea2000Fault, Freeze) {
  put(Wire::kTcp, "canboat");
  expect_freeze_is_published();
}
TEST_F(Nmea2000Fault, Spike) {
  put(Wire::kUdp, "yacht-devices");
  expect_spike_is_not_believed();
}
TEST_F(Nmea2000Fault, Garbage) {
  for (const Wire wire : {Wire::kPty, Wire::kTcp, Wire::kUdp}) {
    put(wire, "yacht-devices");
    expect_garbage_is_refused();
  }
}
TEST_F(Nmea2000Fault, Split) {
  for (const std::string format : {"yacht-devices", "canboat", "canboat-si", "candump", "canboat-plain", "actisense"}) {
    put(Wire::kTcp, format);
    expect_pieces_are_joined();
  }
}
TEST_F(Nmea2000Fault, Partial) {
  for (const std::string format : {"yacht-devices", "canboat", "canboat-si", "candump", "canboat-plain", "actisense"}) {
    put(Wire::kTcp, format);
    expect_parts_are_refused(Wire::kTcp);
  }
  put(Wire::kUdp, "yacht-devices");
  expect_parts_are_refused(Wire::kUdp);
}
TEST_F(Nmea2000Fault, WrongId) {
  for (const std::string format : {"yacht-devices", "canboat"}) {
    put(Wire::kTcp, format, {{"address", std::int64_t{35}}});
    expect_another_is_not_taken("address");
  }
}
TEST_F(Nmea2000Fault, Disconnect) {
  put(Wire::kTcp, "canboat-si");
  expect_silence(FaultKind::kDisconnect, 5.0);
  EXPECT_THAT(bench_.sink.last_detail(), HasSubstr("cannot connect to 127.0.0.1:"));
  expect_return();
}
TEST_F(Nmea2000Fault, Unplug) {
  for (const Wire wire : {Wire::kPty, Wire::kTcp, Wire::kUdp}) {
    put(wire, "yacht-devices");
    expect_silence(FaultKind::kUnplug, 6.0);
    expect_return();
  }
}

/// A bus of this machine's own, which a pair of sockets stands for: like a CAN socket it carries the kernel's frames
/// one by one. Of bytes on a line nothing can be wrong: the controller checks each frame. tests/kernel has a real one.
class CanBus final : public simulators::text::Wire {
 public:
  CanBus() { CanBus::bring_back(); }
  ~CanBus() override { CanBus::take_away(); }
  CanBus(const CanBus&) = delete;
  CanBus& operator=(const CanBus&) = delete;

  std::span<const FaultKind> known_faults() const override {
    static constexpr std::array kKnown = {FaultKind::kUnplug};
    return kKnown;
  }
  std::vector<int> descriptors() const override { return {}; }
  std::string read(std::span<const int> /*ready*/) override { return {}; }
  void write(std::string_view bytes) override { static_cast<void>(::write(ends_[0], bytes.data(), bytes.size())); }
  void take_away() override {
    for (int& end : ends_) {
      if (end >= 0) ::close(end);
      end = -1;
    }
  }
  void bring_back() override {
    if (ends_[0] >= 0) return;
    ASSERT_EQ(socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_NONBLOCK, 0, ends_.data()), 0);
  }
  std::string place() const override { return "a pair of sockets"; }

  /// The kernel's answer to who opens it.
  int open() const {
    errno = ENODEV;
    return ends_[1] < 0 ? -1 : dup(ends_[1]);
  }

 private:
  std::array<int, 2> ends_ = {-1, -1};
};

class Nmea2000CanFault : public MarineBench {
 protected:
  Nmea2000CanFault() : MarineBench("nmea2000") {}

  void put(ParameterValues::Map given = {}) {
    given["transport"] = std::string("can");
    auto wire = std::make_unique<CanBus>();
    const auto open = [bus = wire.get()](const bus::BytePortAddress& /*address*/) { return bus->open(); };
    const Nmea2000SensorSettings settings = nmea2000_sensor_settings_of(values_for("nmea2000", given));
    bench_.put(
        std::make_unique<simulators::text::Simulator>(
            simulators::text::make_nmea2000_can_device(), bench_.observed(std::move(wire)), 4.0,
            simulators::core::MeasuredWind(std::make_unique<StillWind>(kWind)), 1),
        std::make_unique<Nmea2000Sensor>(settings, bench_.impatient(bus::make_can_port(settings.text.address, open))));
    ASSERT_TRUE(is_live()) << bench_.sink.last_detail();
    expect_only_the_wind();
  }
};

TEST_F(Nmea2000CanFault, Silence) {
  put();
  expect_silence_is_told();
}
TEST_F(Nmea2000CanFault, Freeze) {
  put();
  expect_freeze_is_published();
}
TEST_F(Nmea2000CanFault, Spike) {
  put();
  expect_spike_is_not_believed();
}
TEST_F(Nmea2000CanFault, WrongId) {
  put({{"address", std::int64_t{35}}});
  expect_another_is_not_taken("address");
}
TEST_F(Nmea2000CanFault, Exception) {
  put();
  expect_silence(FaultKind::kException, 5.0);
  EXPECT_THAT(bench_.sink.last_detail(), HasSubstr("bus off"));
  EXPECT_GE(bench_.sink.count(decode::Refusal::kException), 15);
  expect_return();
}
TEST_F(Nmea2000CanFault, Unplug) {
  put();
  expect_silence(FaultKind::kUnplug, 6.0);
  EXPECT_THAT(bench_.sink.last_detail(), HasSubstr("there is no CAN interface can0: plug its adapter in"));
  expect_return();
}

/// Its simulator sends nothing to a client that has not subscribed, and then first a storm that it remembers: that is
/// never published, whatever happens to the connection.
class SignalKFault : public MarineBench {
 protected:
  SignalKFault() : MarineBench("signalk") {}

  void put(Wire wire, ParameterValues::Map given = {}) {
    connect(wire, simulators::text::make_signalk_device(wire != Wire::kUdp), 4.0, std::move(given),
            [](const ParameterValues& values, TextBench& bench) -> std::unique_ptr<sensor::Sensor> {
              const SignalKSensorSettings settings = signalk_sensor_settings_of(values);
              return std::make_unique<SignalKSensor>(settings, bench.port(settings.text.address));
            });
    ASSERT_TRUE(is_live()) << bench_.sink.last_detail();
    expect_only_the_wind();
  }
};

TEST_F(SignalKFault, Silence) {
  for (const Wire wire : {Wire::kTcp, Wire::kUdp}) {
    put(wire);
    expect_silence_is_told();
  }
}
TEST_F(SignalKFault, Freeze) {
  put(Wire::kTcp);
  expect_freeze_is_published();
}
TEST_F(SignalKFault, Spike) {
  put(Wire::kTcp);
  expect_spike_is_not_believed();
}
TEST_F(SignalKFault, Garbage) {
  for (const Wire wire : {Wire::kTcp, Wire::kUdp}) {
    put(wire);
    expect_garbage_is_refused();
  }
}
TEST_F(SignalKFault, Split) {
  put(Wire::kTcp);
  expect_pieces_are_joined();
}
TEST_F(SignalKFault, Partial) {
  for (const Wire wire : {Wire::kTcp, Wire::kUdp}) {
    put(wire);
    expect_parts_are_refused(wire);
  }
}
TEST_F(SignalKFault, WrongId) {
  put(Wire::kTcp, {{"source", std::string("n2k.35")}});
  expect_another_is_not_taken("source");
}
TEST_F(SignalKFault, Disconnect) {
  put(Wire::kTcp);
  expect_silence(FaultKind::kDisconnect, 5.0);
  EXPECT_THAT(bench_.sink.last_detail(), HasSubstr("cannot connect to 127.0.0.1:"));
  expect_return();
}
TEST_F(SignalKFault, Unplug) {
  for (const Wire wire : {Wire::kTcp, Wire::kUdp}) {
    put(wire);
    expect_silence(FaultKind::kUnplug, 6.0);
    expect_return();
  }
}

}  // namespace
}  // namespace yuragi::drivers::text
