// Real conversations between separate programs: our driver with yuragi-sim, our driver with a pymodbus server (TCP and
// RTU), mbpoll with yuragi-sim.
#include <chrono>
#include <filesystem>
#include <functional>
#include <stdexcept>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "drivers/sensor/driver.hpp"
#include "tests/support/child_process.hpp"
#include "tests/support/driver_named.hpp"
#include "tests/support/manual_clock.hpp"
#include "tests/support/modbus_servers.hpp"
#include "tests/support/places.hpp"
#include "tests/support/recording_sink.hpp"

namespace yuragi::simulators::modbus {
namespace {

using testing::HasSubstr;

std::unique_ptr<drivers::sensor::Sensor> open_sensor(ParameterValues::Map given) {
  given.try_emplace("response_timeout", 5.0);  // even a machine under load answers within it
  given.try_emplace("profile_dir", test::source_path("drivers/modbus/profiles"));
  return driver_named("modbus").open(values_for("modbus", given));
}

/// yuragi-sim on a free port.
class SimulatorProcess {
 public:
  explicit SimulatorProcess(const std::vector<std::string>& options = {}, const std::string& port = "0")
      : process_([&] {
          std::vector<std::string> command = {test::built_path("bin/yuragi-sim"), "modbus", "--tcp",
                                              "127.0.0.1:" + port};
          command.insert(command.end(), options.begin(), options.end());
          return command;
        }()) {
    port_ = process_.line_after("listening on 127.0.0.1:");
  }

  const std::string& port() const { return port_; }
  ChildProcess& process() { return process_; }

 private:
  ChildProcess process_;
  std::string port_;
};

struct Bench {
  ManualClock clock;
  RecordingSink sink;
  MonoTime due{};

  void poll(drivers::sensor::Sensor& sensor) {
    clock.advance_to(due);
    due = sensor.poll(clock, sink);
  }
  /// Polls until `is_there`; false if that takes longer than anything should.
  template <class Condition>
  bool poll_until(drivers::sensor::Sensor& sensor, Condition&& is_there) {
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(60);
    while (!is_there() && std::chrono::steady_clock::now() < deadline) poll(sensor);
    return is_there();
  }
  bool poll_for_reading(drivers::sensor::Sensor& sensor) {
    const auto before = sink.readings.size();
    return poll_until(sensor, [&] { return sink.readings.size() > before; });
  }
};

TEST(DriverAndSimulator, AgreeOnTheWind) {
  SimulatorProcess simulator({"--speed", "7", "--direction", "123", "--turbulence", "0"});
  const auto sensor = open_sensor({{"port", std::int64_t{std::stoi(simulator.port())}}});
  Bench bench;
  for (int i = 0; i < 10; ++i) ASSERT_TRUE(bench.poll_for_reading(*sensor));
  for (const wind::Reading& reading : bench.sink.readings) {
    EXPECT_NEAR(reading.speed_m_s, 7.0, 1e-9);
    EXPECT_EQ(reading.direction_deg, 123.0);
  }
  EXPECT_TRUE(bench.sink.refusals.empty());
}

TEST(DriverAndSimulator, CountEveryFaultPublishNoneOfItAndComeBack) {
  SimulatorProcess simulator({"--speed", "7", "--direction", "123", "--turbulence", "0"});
  const auto sensor = open_sensor({{"port", std::int64_t{std::stoi(simulator.port())}}, {"response_timeout", 0.2}});
  Bench bench;
  ASSERT_TRUE(bench.poll_for_reading(*sensor));

  const auto counts = [&](drivers::decode::Refusal why) {
    return [&bench, why] { return bench.sink.count(why) >= 2; };
  };
  const std::vector<std::pair<std::string, std::function<bool()>>> faults = {
      {"silence", counts(drivers::decode::Refusal::kTimeout)},
      {"exception", counts(drivers::decode::Refusal::kException)},
      {"wrong-id", counts(drivers::decode::Refusal::kNotMine)},
      {"wrong-transaction", counts(drivers::decode::Refusal::kNotMine)},
      {"partial", counts(drivers::decode::Refusal::kTooShort)},
      // Random bytes look like this or that; none of it is an answer.
      {"garbage",
       [&] {
         return bench.sink.count(drivers::decode::Refusal::kMalformed) +
                    bench.sink.count(drivers::decode::Refusal::kTooShort) >=
                2;
       }},
      {"disconnect", [&] { return bench.sink.last_detail().starts_with("cannot connect"); }},
  };
  for (const auto& [fault, is_counted] : faults) {
    SCOPED_TRACE(fault);
    simulator.process().type(fault + " 600");
    simulator.process().line_after(fault + " for 600 s");

    // The round that was under way may still have been whole.
    EXPECT_TRUE(bench.poll_until(*sensor, [&] { return bench.sink.last_state() == wind::LinkState::kConnecting; }));
    bench.sink.readings.clear();
    bench.sink.refusals.clear();
    EXPECT_TRUE(bench.poll_until(*sensor, is_counted)) << bench.sink.last_detail();
    EXPECT_TRUE(bench.sink.readings.empty());

    simulator.process().type("clear");
    simulator.process().line_after("no faults");
    ASSERT_TRUE(bench.poll_for_reading(*sensor));
    EXPECT_NEAR(bench.sink.readings.back().speed_m_s, 7.0, 1e-9);
    ASSERT_TRUE(bench.poll_until(*sensor, [&] { return bench.sink.readings.back().direction_deg == 123.0; }));
  }
}

TEST(DriverAndSimulator, FindEachOtherAgainAfterTheSimulatorWasKilled) {
  auto simulator = std::make_unique<SimulatorProcess>();
  const std::string port = simulator->port();
  const auto sensor = open_sensor({{"port", std::int64_t{std::stoi(port)}}});
  Bench bench;
  ASSERT_TRUE(bench.poll_for_reading(*sensor));

  simulator->process().end(SIGKILL);
  EXPECT_TRUE(bench.poll_until(*sensor, [&] { return bench.sink.last_detail().starts_with("cannot connect"); }));
  simulator = std::make_unique<SimulatorProcess>(std::vector<std::string>{}, port);
  EXPECT_TRUE(bench.poll_for_reading(*sensor));
  EXPECT_EQ(bench.sink.last_state(), wind::LinkState::kConnected);
}

TEST(SimulatorProgram, FailsOnSchedule) {
  SimulatorProcess simulator({"--fault", "exception@0+600"});
  const auto sensor = open_sensor({{"port", std::int64_t{std::stoi(simulator.port())}}});
  Bench bench;
  EXPECT_TRUE(bench.poll_until(*sensor, [&] { return bench.sink.count(drivers::decode::Refusal::kException) >= 3; }));
  EXPECT_TRUE(bench.sink.readings.empty());
}

TEST(SimulatorProgram, EndsAfterItsDuration) {
  SimulatorProcess simulator({"--duration", "0.1"});
  EXPECT_EQ(simulator.process().wait(), 0);
}

TEST(SimulatorProgram, EndsCleanlyOnSignalsAndGoesOnWhenItsInputEnds) {
  for (const int signal_number : {SIGINT, SIGTERM}) {
    SimulatorProcess simulator;
    simulator.process().close_input();
    const auto sensor = open_sensor({{"port", std::int64_t{std::stoi(simulator.port())}}});
    Bench bench;
    EXPECT_TRUE(bench.poll_for_reading(*sensor));
    EXPECT_EQ(simulator.process().end(signal_number), 0);
  }
}

TEST(SimulatorProgram, RefusesACommandLineThatItCannotUse) {
  const auto run = [](std::vector<std::string> command) {
    command.insert(command.begin(), {test::built_path("bin/yuragi-sim"), "modbus"});
    ChildProcess process(command);
    const std::string text = process.rest();
    return std::pair(process.wait(), text);
  };
  EXPECT_THAT(run({"--tcp", "nowhere"}), testing::Pair(64, HasSubstr("HOST:PORT")));
  EXPECT_THAT(run({"--profile", "x"}), testing::Pair(64, HasSubstr("renke-rs-fsjt-rs-fxjt-n01")));
  EXPECT_THAT(run({"--fault", "silence"}), testing::Pair(64, HasSubstr("KIND@START+DURATION")));
  SimulatorProcess first;
  EXPECT_THAT(run({"--tcp", "127.0.0.1:" + first.port()}), testing::Pair(69, HasSubstr("cannot listen on")));
}

TEST(MbpollAndSimulator, AgreeOnRegistersAndExceptions) {
  if (!std::filesystem::exists("/usr/bin/mbpoll")) GTEST_SKIP() << "mbpoll is not installed";
  SimulatorProcess simulator({"--speed", "7", "--direction", "123", "--turbulence", "0"});
  const auto exchange = [&](const std::string& slave, const std::string& from, const std::string& count) {
    ChildProcess mbpoll({"/usr/bin/mbpoll", "-m", "tcp", "-p", simulator.port(), "-a", slave, "-r", from, "-c", count,
                         "-t", "4", "-1", "-q", "127.0.0.1"});
    return mbpoll.rest();
  };
  EXPECT_THAT(exchange("1", "1", "1"), testing::ContainsRegex("\\[1\\]:[ \t]+70"));
  EXPECT_THAT(exchange("2", "1", "2"), testing::ContainsRegex("\\[2\\]:[ \t]+123"));
  EXPECT_THAT(exchange("1", "2", "1"), HasSubstr("Illegal data address"));
}

/// A pymodbus server, or why there is none.
class PymodbusServer {
 public:
  explicit PymodbusServer(const std::vector<std::string>& arguments)
      : process_([&] {
          std::vector<std::string> command = {"/usr/bin/python3",
                                              test::source_path("tests/simulators/pymodbus_server.py")};
          command.insert(command.end(), arguments.begin(), arguments.end());
          return command;
        }()) {
    listening_on = process_.line_after("listening on ");
  }
  std::string listening_on;

  static bool is_installed() {
    ChildProcess python({"/usr/bin/python3", "-c", "import pymodbus.server.async_io"});
    return python.wait() == 0;
  }

 private:
  ChildProcess process_;
};

TEST(DriverAndPymodbus, AgreeOverTcp) {
  if (!PymodbusServer::is_installed()) GTEST_SKIP() << "python3-pymodbus is not installed";
  const PymodbusServer server({"tcp", "56", "225"});
  const auto sensor = open_sensor({{"port", std::int64_t{std::stoi(server.listening_on)}}, {"response_timeout", 5.0}});
  Bench bench;
  for (int i = 0; i < 3; ++i) ASSERT_TRUE(bench.poll_for_reading(*sensor));
  EXPECT_NEAR(bench.sink.readings.back().speed_m_s, 5.6, 1e-9);
  EXPECT_EQ(bench.sink.readings.back().direction_deg, 225.0);
  EXPECT_TRUE(bench.sink.refusals.empty());
}

TEST(DriverAndPymodbus, AgreeOverASerialLine) {
  if (!PymodbusServer::is_installed()) GTEST_SKIP() << "python3-pymodbus is not installed";
  const SerialBus bus({}, true);
  const PymodbusServer server({bus.another_device(), "56", "225"});
  const auto sensor =
      open_sensor({{"transport", std::string("rtu")}, {"device", bus.device()}, {"response_timeout", 5.0}});
  Bench bench;
  for (int i = 0; i < 3; ++i) ASSERT_TRUE(bench.poll_for_reading(*sensor));
  EXPECT_NEAR(bench.sink.readings.back().speed_m_s, 5.6, 1e-9);
  EXPECT_EQ(bench.sink.readings.back().direction_deg, 225.0);
  EXPECT_TRUE(bench.sink.refusals.empty());
}

}  // namespace
}  // namespace yuragi::simulators::modbus
