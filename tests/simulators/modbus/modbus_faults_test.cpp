// Every fault that a Modbus device, gateway or adapter can suffer, between the real driver in real time and the
// simulator: what the driver says of it, that nothing false comes out, and that the reading returns by itself.
#include <algorithm>
#include <fstream>
#include <functional>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/modbus_programs.hpp"
#include "tests/support/running_sensor.hpp"

namespace yuragi::simulators::modbus {
namespace {

using testing::HasSubstr;
using Transport = test::ModbusSimulatorProgram::Transport;

constexpr double kWindSpeed_m_s = 7.0;
constexpr double kWindDirection_deg = 123.0;
constexpr double kTimeout_s = 0.2;
constexpr double kNoTimeout_s = 10.0;  // where no answer is missing, however busy the machine

std::vector<std::string> options_with(std::vector<std::string> more) {
  std::vector<std::string> options = {"--speed", "7", "--direction", "123"};
  options.insert(options.end(), more.begin(), more.end());
  return options;
}

ParameterValues::Map paced(ParameterValues::Map parameters, double timeout_s, const std::string& profile) {
  if (!profile.empty()) parameters["profile"] = profile;
  parameters["response_timeout"] = timeout_s;
  parameters["poll_interval"] = 0.05;
  return parameters;
}

/// A device (a cup and a vane, unless said otherwise), played by the simulator, and the sensor that reads it. Says
/// everything that the wind is.
class ModbusFaultBench {
 public:
  explicit ModbusFaultBench(Transport transport, const std::vector<std::string>& options = {"--turbulence", "0"},
                            double timeout_s = kTimeout_s, const std::string& profile = "")
      : simulator(transport, options_with(options)),
        sensor(test::open_modbus_sensor(paced(simulator.parameters(), timeout_s, profile))) {
    EXPECT_TRUE(returns()) << detail();
  }

  /// Is a wind with a direction published again, and the link well?
  bool returns() {
    sensor.forget();
    return sensor.wait_until([](const RecordingSink& sink) {
      return !sink.readings.empty() && sink.readings.back().direction_deg &&
             sink.last_state() == wind::LinkState::kConnected;
    });
  }

  /// A fault after which nobody can know the wind: within its time the link is down and says why, each of `refusals` is
  /// counted (twice in all), nothing comes out, and all is well again by itself.
  void expect_loss(const std::string& fault, const std::vector<drivers::decode::Refusal>& refusals,
                   const std::string& text) {
    simulator.suffer(fault);
    ASSERT_TRUE(
        sensor.wait_until([](const RecordingSink& sink) { return sink.last_state() == wind::LinkState::kConnecting; },
                          std::chrono::seconds(5)));
    EXPECT_THAT(detail(), HasSubstr(text));
    sensor.forget();
    const auto is_counted = [&](const RecordingSink& sink) {
      const auto count = [&](drivers::decode::Refusal why) { return sink.count(why); };
      std::ptrdiff_t all = 0;
      for (const drivers::decode::Refusal why : refusals) all += count(why);
      return all >= 2 || refusals.empty();
    };
    EXPECT_TRUE(sensor.wait_until(is_counted)) << detail();
    EXPECT_EQ(published(), 0U);
    EXPECT_EQ(state(), wind::LinkState::kConnecting);

    simulator.be_well();
    expect_true_wind();
  }

  /// All is well again, and what is published until then is the wind.
  void expect_true_wind() {
    ASSERT_TRUE(returns()) << detail();
    sensor.look([](const RecordingSink& sink) {
      for (const wind::Reading& reading : sink.readings) {
        EXPECT_NEAR(reading.speed_m_s, kWindSpeed_m_s, 1e-9);
        EXPECT_EQ(reading.direction_deg.value_or(kWindDirection_deg), kWindDirection_deg);
      }
    });
  }

  /// Waits for so many readings more, and returns their speeds.
  std::vector<double> next_speeds(std::size_t count) {
    sensor.forget();
    EXPECT_TRUE(sensor.wait_until([&](const RecordingSink& sink) { return sink.readings.size() >= count; }));
    return sensor.look([](const RecordingSink& sink) {
      std::vector<double> speeds;
      for (const wind::Reading& reading : sink.readings) speeds.push_back(reading.speed_m_s);
      return speeds;
    });
  }

  std::size_t published() {
    return sensor.look([](const RecordingSink& sink) { return sink.readings.size(); });
  }
  wind::LinkState state() {
    return sensor.look([](const RecordingSink& sink) { return sink.last_state(); });
  }
  std::string detail() {
    return sensor.look([](const RecordingSink& sink) { return sink.last_detail(); });
  }

  test::ModbusSimulatorProgram simulator;
  RunningSensor sensor;
};

/// The device says the same again and again: so does the driver. That it is frozen is judged by the hub.
void expect_frozen_values_as_they_are(Transport transport) {
  ModbusFaultBench bench(transport, {"--turbulence", "0.4"}, kNoTimeout_s);
  bench.simulator.suffer("freeze");
  bench.next_speeds(2);  // one may have been under way
  const std::vector<double> frozen = bench.next_speeds(10);
  EXPECT_THAT(frozen, testing::Each(frozen.front()));
  EXPECT_EQ(bench.state(), wind::LinkState::kConnected);
  bench.simulator.be_well();
  EXPECT_TRUE(bench.sensor.wait_until(
      [&](const RecordingSink& sink) { return sink.readings.back().speed_m_s != frozen.front(); }));
}

/// 55 m/s is a wind that there is: the driver says so. That it came from one moment to the next is judged by the hub.
void expect_a_spike_as_it_is(Transport transport) {
  ModbusFaultBench bench(transport, {"--turbulence", "0"}, kNoTimeout_s);
  bench.simulator.suffer("spike");
  EXPECT_TRUE(
      bench.sensor.wait_until([](const RecordingSink& sink) { return sink.readings.back().speed_m_s == 55.0; }));
  EXPECT_EQ(bench.state(), wind::LinkState::kConnected);
  bench.simulator.be_well();
  bench.next_speeds(2);
  bench.expect_true_wind();
}

/// The right bytes, with pauses: nothing is lost.
void expect_split_replies_to_be_put_together(Transport transport) {
  ModbusFaultBench bench(transport, {"--turbulence", "0"}, kNoTimeout_s);
  bench.simulator.suffer("split");
  EXPECT_THAT(bench.next_speeds(5), testing::Each(testing::DoubleNear(kWindSpeed_m_s, 1e-9)));
  EXPECT_TRUE(bench.sensor.look([](const RecordingSink& sink) { return sink.refusals.empty(); }));
  EXPECT_EQ(bench.state(), wind::LinkState::kConnected);
  bench.simulator.be_well();
  bench.expect_true_wind();
}

const std::vector<drivers::decode::Refusal> kNoise = {
    drivers::decode::Refusal::kMalformed, drivers::decode::Refusal::kTooShort, drivers::decode::Refusal::kBadChecksum,
    drivers::decode::Refusal::kNotMine};

TEST(ModbusFault, Silence) {
  ModbusFaultBench(Transport::kTcp)
      .expect_loss("silence", {drivers::decode::Refusal::kTimeout}, "does not reply within 0.2 s");
}
TEST(ModbusFault, Freeze) {
  expect_frozen_values_as_they_are(Transport::kTcp);
}
TEST(ModbusFault, Spike) {
  expect_a_spike_as_it_is(Transport::kTcp);
}
TEST(ModbusFault, Garbage) {
  ModbusFaultBench(Transport::kTcp).expect_loss("garbage", kNoise, "a reply of slave 1 at 127.0.0.1:");
}
TEST(ModbusFault, Split) {
  expect_split_replies_to_be_put_together(Transport::kTcp);
}
TEST(ModbusFault, Partial) {
  ModbusFaultBench(Transport::kTcp)
      .expect_loss("partial", {drivers::decode::Refusal::kTooShort}, "is invalid (too short)");
}
TEST(ModbusFault, WrongId) {
  ModbusFaultBench(Transport::kTcp)
      .expect_loss("wrong-id", {drivers::decode::Refusal::kNotMine}, "does not reply, but other slaves do");
}
TEST(ModbusFault, WrongTransaction) {
  ModbusFaultBench(Transport::kTcp)
      .expect_loss("wrong-transaction", {drivers::decode::Refusal::kNotMine}, "does not reply, but other slaves do");
}
TEST(ModbusFault, Late) {
  ModbusFaultBench(Transport::kTcp)
      .expect_loss("late", {drivers::decode::Refusal::kTimeout, drivers::decode::Refusal::kNotMine}, "does not reply");
}
TEST(ModbusFault, Exception) {
  ModbusFaultBench(Transport::kTcp)
      .expect_loss("exception", {drivers::decode::Refusal::kException},
                   "refuses the request (exception 4, server device failure)");
}
TEST(ModbusFault, Disconnect) {
  ModbusFaultBench(Transport::kTcp).expect_loss("disconnect", {}, "127.0.0.1:");
}

TEST(ModbusRtuFault, Silence) {
  ModbusFaultBench(Transport::kRtu)
      .expect_loss("silence", {drivers::decode::Refusal::kTimeout}, "does not reply within 0.2 s");
}
TEST(ModbusRtuFault, Freeze) {
  expect_frozen_values_as_they_are(Transport::kRtu);
}
TEST(ModbusRtuFault, Spike) {
  expect_a_spike_as_it_is(Transport::kRtu);
}
TEST(ModbusRtuFault, Garbage) {
  ModbusFaultBench(Transport::kRtu).expect_loss("garbage", kNoise, "slave 1 at ");
}
TEST(ModbusRtuFault, Split) {
  expect_split_replies_to_be_put_together(Transport::kRtu);
}
TEST(ModbusRtuFault, Partial) {
  ModbusFaultBench(Transport::kRtu)
      .expect_loss("partial", {drivers::decode::Refusal::kTooShort}, "is invalid (too short)");
}
TEST(ModbusRtuFault, BadChecksum) {
  ModbusFaultBench(Transport::kRtu)
      .expect_loss("bad-checksum", {drivers::decode::Refusal::kBadChecksum}, "is invalid (bad checksum)");
}
TEST(ModbusRtuFault, WrongId) {
  ModbusFaultBench(Transport::kRtu)
      .expect_loss("wrong-id", {drivers::decode::Refusal::kNotMine}, "does not reply, but other slaves do");
}
TEST(ModbusRtuFault, Late) {
  // Late by less than two time-outs: the driver lets the slave be for so long, and drops what it says then.
  ModbusFaultBench bench(Transport::kRtu, {"--turbulence", "0", "--late-by", "0.3"});
  bench.expect_loss("late", {drivers::decode::Refusal::kTimeout}, "does not reply");
}
TEST(ModbusRtuFault, Exception) {
  ModbusFaultBench(Transport::kRtu)
      .expect_loss("exception", {drivers::decode::Refusal::kException},
                   "refuses the request (exception 4, server device failure)");
}
TEST(ModbusRtuFault, Unplug) {
  ModbusFaultBench(Transport::kRtu).expect_loss("unplug", {}, "bus");
}

/// A copy of its profile that looks at the quantities besides the wind once a second.
std::string hasty_station(const test::TemporaryFolder& folder) {
  std::ifstream in(test::source_path("drivers/modbus/profiles/ecowitt-wn90lp.toml"));
  const std::string path = folder / "hasty.toml";
  std::ofstream out(path);
  for (std::string line; std::getline(in, line);) {
    out << line << "\n";
    if (line == "[timing]") out << "quantities_interval_s = 1\n";
  }
  return path;
}

/// A station that says more than the wind: no fault makes anything false of that either.
void expect_true_air_under(Transport transport, const std::string& fault,
                           const std::vector<drivers::decode::Refusal>& refusals, const std::string& text) {
  const test::TemporaryFolder folder;
  ModbusFaultBench bench(transport, {"--device", "ecowitt-wn90lp", "--turbulence", "0"}, kTimeout_s,
                         hasty_station(folder));
  const auto expect_true_air = [&bench] {
    EXPECT_TRUE(bench.sensor.wait_until([](const RecordingSink& sink) { return !sink.station_quantities.empty(); }));
    bench.sensor.look([](const RecordingSink& sink) {
      for (const wind::StationQuantities& said : sink.station_quantities) {
        EXPECT_NEAR(said.air_temperature_c.value(), -3.7, 1e-9);
        EXPECT_NEAR(said.relative_humidity_percent.value(), 64.0, 1e-9);
        EXPECT_NEAR(said.pressure_hpa.value(), 1009.0, 1e-9);
        EXPECT_NEAR(said.rain_total_mm.value(), 12.6, 1e-9);
      }
    });
  };
  expect_true_air();
  bench.expect_loss(fault, refusals, text);
  expect_true_air();
}

TEST(ModbusStationFault, Silence) {
  expect_true_air_under(Transport::kTcp, "silence", {drivers::decode::Refusal::kTimeout}, "slave 144 at 127.0.0.1:");
}
TEST(ModbusStationFault, Garbage) {
  expect_true_air_under(Transport::kRtu, "garbage", kNoise, "slave 144 at ");
}
TEST(ModbusStationFault, Partial) {
  expect_true_air_under(Transport::kTcp, "partial", {drivers::decode::Refusal::kTooShort}, "is invalid (too short)");
}
TEST(ModbusStationFault, BadChecksum) {
  expect_true_air_under(Transport::kRtu, "bad-checksum", {drivers::decode::Refusal::kBadChecksum},
                        "is invalid (bad checksum)");
}
TEST(ModbusStationFault, Exception) {
  expect_true_air_under(Transport::kTcp, "exception", {drivers::decode::Refusal::kException},
                        "refuses the request (exception 4, server device failure)");
}

}  // namespace
}  // namespace yuragi::simulators::modbus
