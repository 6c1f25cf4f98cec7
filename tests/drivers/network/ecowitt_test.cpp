// The driver as the daemon opens and runs it, and the simulated gateway, over TCP on the loopback.
#include <atomic>
#include <chrono>
#include <future>
#include <memory>
#include <stdexcept>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "simulators/network/ecowitt_simulator.hpp"
#include "tests/support/driver_named.hpp"
#include "tests/support/free_port.hpp"
#include "tests/support/live_sensor.hpp"
#include "tests/support/manual_clock.hpp"
#include "tests/support/scripted_server.hpp"
#include "tests/support/simulator_thread.hpp"
#include "tests/support/still_wind.hpp"

namespace yuragi::drivers::network {
namespace {

using namespace std::chrono_literals;
using simulators::FaultKind;
using simulators::network::EcowittOptions;
using simulators::network::EcowittSimulator;
using testing::AllOf;
using testing::Each;
using testing::Field;
using testing::HasSubstr;
using testing::Optional;
using testing::ThrowsMessage;

constexpr simulators::PlayedMoment kGatewayWind = {.speed_m_s = 7.3, .direction_deg = 123.0};

/// A driver that asks the gateway at this port of this machine often.
std::unique_ptr<sensor::Sensor> open_gateway(std::uint16_t port, ParameterValues::Map given = {}) {
  given.try_emplace("host", std::string("127.0.0.1"));
  given.try_emplace("port", std::int64_t{port});
  given.try_emplace("poll_interval", 0.1);
  given.try_emplace("sensor_interval", 0.2);
  return driver_named("ecowitt").open(values_for("ecowitt", given));
}

std::unique_ptr<EcowittSimulator> gateway() {
  EcowittOptions options;
  options.port = 0;
  options.interval_s = 0.2;
  options.late_s = 1.0;
  return std::make_unique<EcowittSimulator>(options,
                                            simulators::MeasuredWind(std::make_unique<StillWind>(kGatewayWind)));
}

class EcowittFault : public testing::Test {
 protected:
  EcowittFault() : EcowittFault(gateway()) {}

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
  /// Suffers it until so much was refused, and says no wind meanwhile.
  void expect_refusals(FaultKind fault, decode::Refusal why, const std::string& detail) {
    simulator_.set_fault(fault);
    ASSERT_TRUE(live_.wait_until([&] { return live_.sink.count(why) >= 1; })) << live_.sink.last_detail();
    live_.sink.readings.clear();  // the reply to a request from before
    ASSERT_TRUE(live_.wait_until([&] { return live_.sink.count(why) >= 4; })) << live_.sink.last_detail();
    EXPECT_TRUE(live_.sink.readings.empty());
    EXPECT_EQ(live_.sink.last_state(), wind::LinkState::kConnecting);
    EXPECT_THAT(live_.sink.last_detail(), HasSubstr(detail));
  }
  void expect_only_the_wind() const {
    EXPECT_THAT(live_.sink.readings, Each(AllOf(Field(&wind::WindReading::speed_m_s, testing::DoubleNear(7.3, 1e-9)),
                                                Field(&wind::WindReading::direction_deg, Optional(123.0)))));
  }
  void forget() {
    live_.sink.readings.clear();
    live_.sink.refusals.clear();
  }

 private:
  explicit EcowittFault(std::unique_ptr<EcowittSimulator> simulator)
      : port_(simulator->port()),
        simulator_(std::move(simulator)),
        live_(open_gateway(port_, {{"response_timeout", 0.5}})) {}

  std::uint16_t port_;

 protected:
  SimulatorThread simulator_;
  test::LiveSensor live_;
};

TEST_F(EcowittFault, Silence) {
  expect_refusals(FaultKind::kSilence, decode::Refusal::kTimeout, "does not reply within 0.5 s");
  expect_return();
}

TEST_F(EcowittFault, Freeze) {
  simulator_.set_fault(FaultKind::kFreeze);
  ASSERT_TRUE(live_.wait_for_readings(5)) << "the driver publishes what the gateway says; the hub judges it";
  expect_only_the_wind();
  expect_return();
}

TEST_F(EcowittFault, Spike) {
  ASSERT_TRUE(live_.wait_for_readings(20)) << "by which a spike is known";
  simulator_.set_fault(FaultKind::kSpike);
  ASSERT_TRUE(
      live_.wait_until([&] { return !live_.sink.readings.empty() && live_.sink.readings.back().speed_m_s == 55.0; }));
  EXPECT_EQ(live_.sink.judge.fault(), wind::judging::ReadingFault::kSpike);
  for (const wind::WindReading& believed : live_.sink.believed) EXPECT_NEAR(believed.speed_m_s, 7.3, 1e-9);
}

TEST_F(EcowittFault, Garbage) {
  expect_refusals(FaultKind::kGarbage, decode::Refusal::kMalformed, "cannot be used (malformed)");
  expect_return();
}

TEST_F(EcowittFault, Split) {
  simulator_.set_fault(FaultKind::kSplit);
  ASSERT_TRUE(live_.wait_for_readings(5)) << live_.sink.last_detail();
  expect_only_the_wind();
  EXPECT_TRUE(live_.sink.refusals.empty());
  expect_return();
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
  expect_refusals(FaultKind::kUnplug, decode::Refusal::kInvalid, "hears no anemometer");
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
  const auto claims = driver_named("ecowitt").claims(values_for("ecowitt", {{"host", std::string("gw")}}));
  ASSERT_EQ(claims.size(), 1U);
  EXPECT_EQ(claims[0].device, "gateway gw:45000");
  EXPECT_FALSE(claims[0].is_shared);
}

}  // namespace
}  // namespace yuragi::drivers::network
