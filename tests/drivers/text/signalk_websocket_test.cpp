// A Signal K server's stream by WebSocket, simulated, and what can go wrong with it: the driver as the daemon opens and
// runs it. What a server says is tested in signalk_sensor_test.cpp.
#include <memory>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "simulators/text/signalk_device.hpp"
#include "simulators/text/text_simulator.hpp"
#include "tests/support/driver_named.hpp"
#include "tests/support/live_sensor.hpp"
#include "tests/support/simulator_thread.hpp"
#include "tests/support/still_wind.hpp"

namespace yuragi::drivers::text {
namespace {

using namespace std::chrono_literals;
using simulators::core::FaultKind;
using testing::HasSubstr;
using testing::ThrowsMessage;

constexpr simulators::core::PlayedMoment kWindAtSea = {.speed_m_s = 7.25, .direction_deg = 123.0};

std::unique_ptr<simulators::text::Simulator> signalk_server(const std::string& token) {
  return std::make_unique<simulators::text::Simulator>(
      simulators::text::make_signalk_device(true),
      simulators::text::make_websocket_wire({.path = "/signalk/v1/stream", .token = token}), 20.0,
      simulators::core::MeasuredWind(std::make_unique<StillWind>(kWindAtSea)), 1);
}

std::unique_ptr<sensor::Sensor> open_signalk(const simulators::text::Wire& wire, ParameterValues::Map given) {
  const std::string place = wire.place();
  given.try_emplace("transport", std::string("websocket"));
  given.try_emplace("host", std::string("127.0.0.1"));
  given.try_emplace("port", std::int64_t{std::stoi(place.substr(place.rfind(':') + 1))});
  return driver_named("signalk").open(values_for("signalk", given));
}

class SignalKWebSocketFault : public testing::Test {
 protected:
  SignalKWebSocketFault() : SignalKWebSocketFault(signalk_server("a.b-c")) {}

  void SetUp() override { expect_return(); }

  /// It says the wind, and nothing else; a storm that the server remembers is none.
  void expect_return() {
    simulator_.set_fault({});
    ASSERT_TRUE(live_.wait_for_readings(1)) << live_.sink.last_detail();
    live_.sink.readings.clear();
    ASSERT_TRUE(live_.wait_for_readings(3)) << live_.sink.last_detail();
    EXPECT_EQ(live_.sink.last_state(), wind::LinkState::kConnected) << live_.sink.last_detail();
    for (const wind::Reading& reading : live_.sink.readings) {
      EXPECT_NEAR(reading.speed_m_s, kWindAtSea.speed_m_s, 0.001);
      EXPECT_NEAR(reading.direction_deg.value_or(-1.0), kWindAtSea.direction_deg, 0.01);
    }
  }
  /// Suffers it until the link says so, and then publishes nothing.
  void expect_trouble(FaultKind fault, const std::string& detail) {
    simulator_.set_fault(fault);
    ASSERT_TRUE(live_.wait_until([&] {
      return live_.sink.last_state() == wind::LinkState::kConnecting &&
             live_.sink.last_detail().find(detail) != std::string::npos;
    })) << live_.sink.last_detail();
    live_.sink.readings.clear();
    live_.listen_for(300ms);
    EXPECT_TRUE(live_.sink.readings.empty());
    expect_return();
  }

  test::LiveSensor live_;
  SimulatorThread simulator_;

 private:
  explicit SignalKWebSocketFault(std::unique_ptr<simulators::text::Simulator> simulator)
      : live_(open_signalk(simulator->wire(), {{"token", Secret("a.b-c")}})), simulator_(std::move(simulator)) {}
};

TEST_F(SignalKWebSocketFault, Silence) {
  expect_trouble(FaultKind::kSilence, "is open, but silent");
}
TEST_F(SignalKWebSocketFault, Freeze) {
  simulator_.set_fault(FaultKind::kFreeze);
  EXPECT_TRUE(live_.wait_for_readings(5)) << "the driver publishes what the server says; the hub judges it";
  expect_return();
}
TEST_F(SignalKWebSocketFault, Spike) {
  simulator_.set_fault(FaultKind::kSpike);
  EXPECT_TRUE(live_.wait_until([&] {
    return !live_.sink.readings.empty() && live_.sink.readings.back().speed_m_s > 50.0;
  })) << "the driver publishes what the server says; the hub judges it";
  simulator_.set_fault({});
  ASSERT_TRUE(live_.wait_until([&] { return live_.sink.readings.back().speed_m_s < 50.0; }));
  expect_return();
}
TEST_F(SignalKWebSocketFault, Garbage) {
  expect_trouble(FaultKind::kGarbage, "");
}
TEST_F(SignalKWebSocketFault, Split) {
  simulator_.set_fault(FaultKind::kSplit);
  live_.sink.refusals.clear();
  EXPECT_TRUE(live_.wait_for_readings(5));
  EXPECT_TRUE(live_.sink.refusals.empty());
  expect_return();
}
TEST_F(SignalKWebSocketFault, Partial) {
  expect_trouble(FaultKind::kPartial, "is open, but silent");
}
TEST_F(SignalKWebSocketFault, Exception) {
  expect_trouble(FaultKind::kException, "refuses the connection (HTTP 503 Service Unavailable)");
}
TEST_F(SignalKWebSocketFault, Disconnect) {
  expect_trouble(FaultKind::kDisconnect, "cannot connect to ws://127.0.0.1:");
}
TEST_F(SignalKWebSocketFault, Unplug) {
  expect_trouble(FaultKind::kUnplug, "cannot connect to ws://127.0.0.1:");
}

TEST(SignalKWebSocket, SaysThatItNeedsAToken) {
  auto simulator = signalk_server("secret.token");
  test::LiveSensor live(open_signalk(simulator->wire(), {}));
  const SimulatorThread running(std::move(simulator));
  EXPECT_TRUE(live.wait_until([&] { return live.sink.last_detail().find("it requires a token") != std::string::npos; }))
      << live.sink.last_detail();
}

TEST(SignalKWebSocket, RefusesSettingsThatCannotWork) {
  const auto wire = simulators::text::make_websocket_wire({});
  const auto open = [&](ParameterValues::Map given) {
    return [&wire, given = std::move(given)] { open_signalk(*wire, given); };
  };
  EXPECT_THAT(open({{"host", std::string("")}}),
              ThrowsMessage<std::runtime_error>(HasSubstr("transport websocket needs a server to connect to")));
  EXPECT_THAT(open({{"path", std::string("signalk")}}),
              ThrowsMessage<std::runtime_error>(HasSubstr("path: is not a path on a server")));
  EXPECT_THAT(open({{"path", std::string("/a b")}}), ThrowsMessage<std::runtime_error>(HasSubstr("path: ")));
  EXPECT_THAT(open({{"token", Secret("a\r\nHost: b")}}),
              ThrowsMessage<std::runtime_error>(HasSubstr("token: is not a token: it contains blanks")));
  EXPECT_THAT(open({{"token", Secret("a")}, {"token_env", std::string("B")}}),
              ThrowsMessage<std::runtime_error>(HasSubstr("token: is set more than once")));
  EXPECT_THAT(open({{"token_env", std::string("YURAGI_NO_SUCH_TOKEN")}}),
              ThrowsMessage<std::runtime_error>(HasSubstr("token_env: the environment variable")));
}

}  // namespace
}  // namespace yuragi::drivers::text
