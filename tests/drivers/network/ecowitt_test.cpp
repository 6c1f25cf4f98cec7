// The driver as the daemon opens and runs it, and the simulated gateway, over TCP on the loopback.
#include <atomic>
#include <chrono>
#include <future>
#include <memory>
#include <stdexcept>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "simulators/network/ecowitt_simulator.hpp"
#include "tests/drivers/network/gateway_fault.hpp"
#include "tests/support/driver_named.hpp"
#include "tests/support/free_port.hpp"
#include "tests/support/manual_clock.hpp"
#include "tests/support/scripted_server.hpp"
#include "tests/support/still_wind.hpp"

namespace yuragi::drivers::network {
namespace {

using namespace std::chrono_literals;
using simulators::core::FaultKind;
using simulators::network::EcowittOptions;
using simulators::network::EcowittSimulator;
using testing::HasSubstr;
using testing::ThrowsMessage;

/// A driver that asks the gateway at this port of this machine often.
std::unique_ptr<sensor::Sensor> open_gateway(std::uint16_t port, ParameterValues::Map given = {}) {
  given.try_emplace("host", std::string("127.0.0.1"));
  given.try_emplace("port", std::int64_t{port});
  given.try_emplace("poll_interval", 0.1);
  given.try_emplace("sensor_interval", 0.2);
  return driver_named("ecowitt").open(values_for("ecowitt", given));
}

class EcowittFault : public GatewayFault {
 protected:
  EcowittFault() : EcowittFault(free_port(SOCK_STREAM)) {}

 private:
  explicit EcowittFault(std::uint16_t port)
      : GatewayFault(gateway(port), open_gateway(port, {{"response_timeout", 0.5}}), 1e-9) {}

  static std::unique_ptr<EcowittSimulator> gateway(std::uint16_t port) {
    EcowittOptions options;
    options.port = port;
    options.interval_s = 0.2;
    options.late_s = 1.0;
    return std::make_unique<EcowittSimulator>(options,
                                              simulators::core::MeasuredWind(std::make_unique<StillWind>(kWind)));
  }
};

TEST_F(EcowittFault, Silence) {
  expect_refusals(FaultKind::kSilence, decode::Refusal::kTimeout, "does not reply within 0.5 s");
  expect_return();
}

TEST_F(EcowittFault, Freeze) {
  expect_freeze_is_published();
}

TEST_F(EcowittFault, Spike) {
  expect_spike_is_not_believed();
}

TEST_F(EcowittFault, Garbage) {
  expect_refusals(FaultKind::kGarbage, decode::Refusal::kMalformed, "cannot be used (malformed)");
  expect_return();
}

TEST_F(EcowittFault, Split) {
  expect_pieces_are_joined();
}

TEST_F(EcowittFault, Partial) {
  expect_refusals(FaultKind::kPartial, decode::Refusal::kTooShort, "cannot be used (too short)");
  expect_return();
}

TEST_F(EcowittFault, BadChecksum) {
  expect_refusals(FaultKind::kBadChecksum, decode::Refusal::kBadChecksum, "cannot be used (bad checksum)");
  expect_return();
}

TEST_F(EcowittFault, WrongTransaction) {
  expect_refusals(FaultKind::kWrongTransaction, decode::Refusal::kNotMine, "cannot be used (not mine)");
  expect_return();
}

TEST_F(EcowittFault, Late) {
  expect_refusals(FaultKind::kLate, decode::Refusal::kTimeout, "does not reply within 0.5 s");
  expect_return();
}

TEST_F(EcowittFault, Disconnect) {
  simulator_.set_fault(FaultKind::kDisconnect);
  ASSERT_TRUE(live_.wait_until([&] {
    return live_.sink.last_detail().find("cannot connect to 127.0.0.1:") != std::string::npos;
  })) << live_.sink.last_detail();
  EXPECT_EQ(live_.sink.last_state(), wind::LinkState::kConnecting);
  expect_return();
}

TEST_F(EcowittFault, Unplug) {
  expect_refusals(FaultKind::kUnplug, decode::Refusal::kInvalid, "receives no anemometer");
  expect_return();
}

/// A reply with a mean wind of so many tenths of m/s, and 12.5 degrees Celsius.
ScriptedServer::Bytes reply_with(std::uint8_t speed) {
  ScriptedServer::Bytes reply = {0xFF, 0xFF, 0x27, 0x00, 0x0D, 0x02, 0x00, 0x7D, 0x0A, 0x00, 0x5A, 0x0B, 0x00, speed};
  unsigned sum = 0;
  for (std::size_t i = 2; i < reply.size(); ++i) sum += reply[i];
  reply.push_back(static_cast<std::uint8_t>(sum & 0xFFU));
  return reply;
}

/// The driver in a time that the test makes, and what it says.
struct EcowittBench {
  ManualClock clock;
  RecordingSink sink;
  MonoTime due = clock.now().mono;

  void poll(sensor::Sensor& sensor) {
    clock.advance_to(due);
    due = sensor.poll(clock, sink);
  }
};

TEST(EcowittDriver, PublishesWhatIsNew) {
  std::atomic<std::uint8_t> speed = 50;
  const ScriptedServer server([&](const ScriptedServer::Bytes& request) -> std::optional<ScriptedServer::Bytes> {
    return request == ScriptedServer::Bytes{0xFF, 0xFF, 0x27, 0x03, 0x2A} ? std::optional(reply_with(speed))
                                                                          : std::nullopt;
  });
  const auto sensor =
      open_gateway(server.port(), {{"poll_interval", 4.0}, {"sensor_interval", 16.0}, {"response_timeout", 60.0}});
  EcowittBench bench;
  for (int i = 0; i < 4; ++i) bench.poll(*sensor);  // opens, and asks at 0, 4 and 8 s
  ASSERT_EQ(bench.sink.readings.size(), 1U) << bench.sink.last_detail();
  speed = 51;
  bench.poll(*sensor);  // 12 s
  ASSERT_EQ(bench.sink.readings.size(), 2U);
  EXPECT_NEAR(bench.sink.readings.back().speed_m_s, 5.1, 1e-9);
  EXPECT_EQ(bench.sink.readings.back().direction_deg, 90.0);

  // The same again is new only after the anemometer's interval.
  for (int i = 0; i < 3; ++i) bench.poll(*sensor);  // 16, 20, 24 s
  EXPECT_EQ(bench.sink.readings.size(), 2U);
  bench.poll(*sensor);  // 28 s
  EXPECT_EQ(bench.sink.readings.size(), 3U);

  ASSERT_EQ(bench.sink.station_quantities.size(), 3U);
  EXPECT_EQ(bench.sink.station_quantities[0].air_temperature_c, 12.5);
  EXPECT_TRUE(bench.sink.refusals.empty());
}

TEST(EcowittDriver, SaysThatItIsNoGateway) {
  const ScriptedServer server([](const ScriptedServer::Bytes&) { return std::nullopt; });
  const auto sensor = open_gateway(server.port());
  EcowittBench bench;
  for (int i = 0; i < 3; ++i) bench.poll(*sensor);
  EXPECT_THAT(bench.sink.last_detail(), HasSubstr("has closed the connection"));
  EXPECT_EQ(bench.sink.last_state(), wind::LinkState::kConnecting);
}

TEST(EcowittDriver, EndsAtOnce) {
  std::promise<void> is_asked;
  const ScriptedServer server([&](const ScriptedServer::Bytes&) {
    is_asked.set_value();
    return ScriptedServer::Bytes{};
  });
  test::LiveSensor live(open_gateway(server.port(), {{"response_timeout", 60.0}}));
  ASSERT_EQ(is_asked.get_future().wait_for(RunningSensor::kHang), std::future_status::ready);
  live.end();
  EXPECT_THAT(live.sink.last_detail(), HasSubstr("interrupted"));
}

TEST(EcowittSettings, AreChecked) {
  EXPECT_THAT([] { driver_named("ecowitt").open(values_for("ecowitt", {})); },
              ThrowsMessage<std::runtime_error>(HasSubstr("host: is missing")));
}

}  // namespace
}  // namespace yuragi::drivers::network
