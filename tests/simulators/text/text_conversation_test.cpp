// Real conversations between separate programs, in real time: the nmea and line drivers with yuragi-sim over a pseudo
// terminal, TCP and UDP, and with socat, which knows nothing of either.
#include <chrono>
#include <filesystem>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "daemon/sensing/system_clock.hpp"
#include "tests/support/child_process.hpp"
#include "tests/support/driver_named.hpp"
#include "tests/support/free_port.hpp"
#include "tests/support/live_sensor.hpp"
#include "tests/support/places.hpp"
#include "tests/support/temporary_folder.hpp"

namespace yuragi::simulators::text {
namespace {

using testing::HasSubstr;

/// yuragi-sim with a wind that stands still, once it is where it should be.
class TextSimulatorProcess {
 public:
  TextSimulatorProcess(const std::string& kind, const std::vector<std::string>& options)
      : process_([&] {
          std::vector<std::string> command = {
              test::built_path("bin/yuragi-sim"), kind, "--speed", "7", "--direction", "123", "--turbulence", "0"};
          command.insert(command.end(), options.begin(), options.end());
          return command;
        }()) {
    const bool sends = std::ranges::find(options, "--udp") != options.end();
    place_ = process_.line_after(sends ? "sending to " : "listening on ");
  }

  const std::string& place() const { return place_; }
  std::int64_t port() const { return std::stoi(place_.substr(place_.rfind(':') + 1)); }
  ChildProcess& process() { return process_; }

 private:
  ChildProcess process_;
  std::string place_;
};

/// A sensor of the table, as the daemon runs it.
class TextSensorRun : public test::LiveSensor {
 public:
  TextSensorRun(std::string_view driver, const ParameterValues::Map& given)
      : test::LiveSensor(driver_named(driver).open(values_for(driver, given))) {}

  bool receives(std::size_t readings) {
    wait_until([] { return true; });
    sink.readings.clear();
    return wait_for_readings(readings);
  }
  void expect_the_wind() const {
    ASSERT_FALSE(sink.readings.empty());
    for (const wind::Reading& reading : sink.readings) {
      EXPECT_NEAR(reading.speed_m_s, 7.0, 0.06);
      ASSERT_TRUE(reading.direction_deg.has_value());
      EXPECT_NEAR(*reading.direction_deg, 123.0, 0.6);
    }
  }
};

ParameterValues::Map tcp_to(std::int64_t port) {
  return {{"transport", std::string("tcp")}, {"host", std::string("127.0.0.1")}, {"port", port}};
}

TEST(TextConversation, AgreesOnTheWindInEveryFormat) {
  for (const std::string format : {"mwv", "mwd", "vwr", "vwt", "mda", "xdr", "gill", "gill-uv", "ft", "umb", "wxt"}) {
    SCOPED_TRACE(format);
    const test::TemporaryFolder folder;
    const std::string link = (folder / "anemometer").string();
    TextSimulatorProcess simulator("nmea", {"--pty", "--link", link, "--format", format, "--rate", "20"});
    EXPECT_EQ(simulator.place(), link);
    TextSensorRun live("nmea", {{"device", link},
                                {"format", std::string(format == "umb" ? "umb" : "auto")},
                                {"poll_interval", format == "umb" ? 0.1 : 0.0}});
    ASSERT_TRUE(live.receives(3)) << live.sink.last_detail();
    live.expect_the_wind();
    EXPECT_TRUE(live.sink.refusals.empty());
  }
}

TEST(TextConversation, AgreesOverTcpAndUdp) {
  TextSimulatorProcess server("nmea", {"--tcp", "127.0.0.1:0", "--format", "mwd,mwv", "--rate", "20"});
  TextSensorRun client("nmea", tcp_to(server.port()));
  ASSERT_TRUE(client.receives(5)) << client.sink.last_detail();
  client.expect_the_wind();
  EXPECT_TRUE(client.sink.refusals.empty());

  const std::int64_t udp_port = free_port(SOCK_DGRAM);
  TextSimulatorProcess talker("nmea", {"--udp", "127.0.0.1:" + std::to_string(udp_port), "--rate", "20"});
  TextSensorRun listener("nmea", {{"transport", std::string("udp")}, {"port", udp_port}});
  ASSERT_TRUE(listener.receives(5)) << listener.sink.last_detail();
  listener.expect_the_wind();
}

TEST(TextConversation, AsksOverTcp) {
  for (const std::string format : {"ft", "wxt"}) {
    TextSimulatorProcess server("nmea", {"--tcp", "127.0.0.1:0", "--format", format, "--rate", "0"});
    auto given = tcp_to(server.port());
    given["format"] = format;
    given["poll_interval"] = 0.1;
    TextSensorRun client("nmea", given);
    ASSERT_TRUE(client.receives(5)) << client.sink.last_detail();
    client.expect_the_wind();
  }
}

TEST(TextConversation, AgreesOnTheWindOfABus) {
  for (const std::string format : {"yacht-devices", "canboat", "canboat-si", "candump", "canboat-plain", "actisense"}) {
    SCOPED_TRACE(format);
    TextSimulatorProcess gateway("nmea2000", {"--tcp", "127.0.0.1:0", "--format", format, "--rate", "20"});
    TextSensorRun live("nmea2000", tcp_to(gateway.port()));
    ASSERT_TRUE(live.receives(5)) << live.sink.last_detail();
    live.expect_the_wind();
  }
}

TEST(TextConversation, AgreesWithASignalKServerAndADevice) {
  TextSimulatorProcess server("signalk", {"--tcp", "127.0.0.1:0", "--rate", "20"});
  TextSensorRun client("signalk", tcp_to(server.port()));
  ASSERT_TRUE(client.receives(5)) << client.sink.last_detail();
  client.expect_the_wind();

  const std::int64_t udp_port = free_port(SOCK_DGRAM);
  TextSimulatorProcess device("signalk", {"--udp", "127.0.0.1:" + std::to_string(udp_port), "--rate", "20"});
  TextSensorRun listener("signalk", {{"transport", std::string("udp")}, {"port", udp_port}});
  ASSERT_TRUE(listener.receives(5)) << listener.sink.last_detail();
  listener.expect_the_wind();
}

TEST(TextConversation, AgreesOnLinesOfNumbers) {
  for (const std::string format : {"csv", "key-value", "units", "json"}) {
    TextSimulatorProcess simulator("line", {"--tcp", "127.0.0.1:0", "--format", format, "--rate", "20"});
    TextSensorRun live("line", tcp_to(simulator.port()));
    ASSERT_TRUE(live.receives(5)) << live.sink.last_detail();
    live.expect_the_wind();
    EXPECT_TRUE(live.sink.refusals.empty());
  }
}

TEST(TextConversation, ComesBackFromEveryFault) {
  const test::TemporaryFolder folder;
  const std::string link = (folder / "anemometer").string();
  TextSimulatorProcess simulator("nmea", {"--pty", "--link", link, "--rate", "20"});
  TextSensorRun live("nmea", {{"device", link}, {"talker", std::string("WI")}});
  ASSERT_TRUE(live.receives(10));

  const std::vector<std::pair<std::string, std::string>> faults = {
      {"silence", "but silent"}, {"garbage", "but no lines: check baud"},
      {"partial", "check"},      {"bad-checksum", "checksums"},
      {"wrong-id", "talker"},    {"unplug", "check that it is plugged in"},
  };
  for (const auto& [fault, detail] : faults) {
    SCOPED_TRACE(fault);
    simulator.process().type(fault + " 600");
    simulator.process().line_after(fault + " for 600 s");
    ASSERT_TRUE(live.wait_until([&] { return live.sink.last_state() == wind::LinkState::kConnecting; }));
    EXPECT_TRUE(live.wait_until([&, said = detail] { return live.sink.last_detail().find(said) != std::string::npos; }))
        << live.sink.last_detail();
    live.expect_the_wind();  // all that came until then

    simulator.process().type("clear");
    simulator.process().line_after("no faults");
    ASSERT_TRUE(live.receives(10)) << live.sink.last_detail();
    live.expect_the_wind();
    EXPECT_EQ(live.sink.last_state(), wind::LinkState::kConnected);
  }
}

TEST(TextConversation, FindsASimulatorAgainThatWasKilled) {
  const test::TemporaryFolder folder;
  const std::string link = (folder / "anemometer").string();
  const std::vector<std::string> options = {"--pty", "--link", link, "--rate", "20"};
  auto simulator = std::make_unique<TextSimulatorProcess>("line", options);
  TextSensorRun live("line", {{"device", link}, {"delay_after_open", 0.0}});
  ASSERT_TRUE(live.receives(3));
  simulator->process().end(SIGKILL);
  EXPECT_TRUE(live.wait_until([&] { return live.sink.last_state() == wind::LinkState::kConnecting; }));
  simulator = std::make_unique<TextSimulatorProcess>("line", options);
  ASSERT_TRUE(live.receives(3)) << live.sink.last_detail();
  live.expect_the_wind();
}

/// Whoever shuts the daemon down waits for no device: nothing is read any more, and nothing is looked up.
TEST(TextConversation, CanBeInterruptedWhateverItWaitsFor) {
  const daemon::sensing::SystemClock clock;
  const std::int64_t udp_port = free_port(SOCK_DGRAM);
  TextSimulatorProcess server("nmea", {"--tcp", "127.0.0.1:0", "--rate", "20"});
  TextSimulatorProcess talker("nmea", {"--udp", "127.0.0.1:" + std::to_string(udp_port), "--rate", "20"});
  for (const auto& given : {tcp_to(server.port()), {{"transport", std::string("udp")}, {"port", udp_port}}}) {
    const auto sensor = driver_named("nmea").open(values_for("nmea", given));
    RecordingSink sink;
    while (sink.readings.empty()) sensor->poll(clock, sink);
    sensor->interrupt();
    sink.readings.clear();
    for (int i = 0; i < 10; ++i) sensor->poll(clock, sink);
    EXPECT_TRUE(sink.readings.empty()) << "it still reads";
  }
  TextSensorRun lost("nmea", {{"transport", std::string("tcp")}, {"host", std::string("no-such-host.invalid")}});
  lost.end();
  EXPECT_FALSE(lost.sink.links.empty());
}

/// Lets the far end say something, again and again as a device does, until it is heard.
void expect_received(TextSensorRun& listener, ChildProcess& far_end, const std::string& line) {
  const auto is_received = [&] { return !listener.sink.readings.empty(); };
  const MonoTime hang = std::chrono::steady_clock::now() + RunningSensor::kHang;
  do {
    far_end.type(line);
  } while (!listener.wait_until(is_received, std::chrono::milliseconds(100)) &&
           std::chrono::steady_clock::now() < hang);
  ASSERT_TRUE(is_received());
}

TEST(TextConversation, ListensToSocat) {
  if (!std::filesystem::exists("/usr/bin/socat")) GTEST_SKIP() << "socat is not installed";
  // A serial line whose far end socat holds, and which passes on what the test types.
  const test::TemporaryFolder folder;
  const std::string link = (folder / "line").string();
  ChildProcess serial({"/usr/bin/socat", "-u", "STDIN", "PTY,rawer,link=" + link});
  TextSensorRun live("nmea", {{"device", link}});
  expect_received(live, serial, "$HDMWV,260.1,R,21.5,K,A*07\r");  // a real one, of Sassnitz
  EXPECT_NEAR(live.sink.readings.back().speed_m_s, 21.5 / 3.6, 1e-9);
  EXPECT_EQ(live.sink.readings.back().direction_deg, 260.1);

  const std::int64_t udp_port = free_port(SOCK_DGRAM);
  ChildProcess talker({"/usr/bin/socat", "-u", "STDIN", "UDP4-SENDTO:127.0.0.1:" + std::to_string(udp_port)});
  TextSensorRun listener("line", {{"transport", std::string("udp")}, {"port", udp_port}});
  expect_received(listener, talker, "4.2,270");
  EXPECT_DOUBLE_EQ(listener.sink.readings.back().speed_m_s, 4.2);
}

/// What a library that has nothing to do with us makes of the simulator's sentences.
TEST(TextConversation, IsUnderstoodByPynmea2) {
  ChildProcess library({"/usr/bin/python3", "-c", "import pynmea2"});
  if (library.wait() != 0) GTEST_SKIP() << "python3-nmea2 is not installed";
  TextSimulatorProcess simulator("nmea", {"--tcp", "127.0.0.1:0", "--format", "mwv,mwd,vwr,vwt,mda,xdr"});
  ChildProcess reader({"/usr/bin/python3", test::source_path("tests/simulators/nmea2_reader.py"),
                       std::to_string(simulator.port()), "6"});
  EXPECT_EQ(reader.line_after("MWV "), "123.0 R 7.00 M A");
  EXPECT_EQ(reader.line_after("MWD "), "123.0 13.61 7.00");
  EXPECT_EQ(reader.line_after("VWR "), "123.0 R 13.61 7.0 25.2");
  EXPECT_EQ(reader.line_after("VWT "), "123.0 R 13.61 7.00 25.20");
  EXPECT_EQ(reader.line_after("MDA "), "123.0 13.61 7.00");
  EXPECT_EQ(reader.line_after("XDR "), "A:118:D:0 A:123:D:1 A:128:D:2 S:6.3:M:0 S:7.0:M:1 S:7.7:M:2");
  EXPECT_EQ(reader.wait(), 0);
}

TEST(TextSimulatorProgram, RefusesACommandLineThatItCannotUse) {
  const auto run = [](std::vector<std::string> command) {
    command.insert(command.begin(), test::built_path("bin/yuragi-sim"));
    ChildProcess process(command);
    const std::string text = process.rest();
    return std::pair(process.wait(), text);
  };
  EXPECT_THAT(run({"nmea"}), testing::Pair(64, HasSubstr("--pty")));
  EXPECT_THAT(run({"nmea", "--pty", "--tcp", "127.0.0.1:0"}), testing::Pair(64, HasSubstr("Exactly 1 option")));
  EXPECT_THAT(run({"nmea", "--pty", "--format", "mwx"}), testing::Pair(64, HasSubstr("mwv")));
  EXPECT_THAT(run({"nmea", "--pty", "--format", "umb,mwv"}), testing::Pair(64, HasSubstr("cannot be combined")));
  EXPECT_THAT(run({"line", "--tcp", "nowhere"}), testing::Pair(64, HasSubstr("HOST:PORT")));
  EXPECT_THAT(run({"line", "--udp", "127.0.0.1:9", "--rate", "0"}),
              testing::Pair(64, HasSubstr("this connection cannot receive requests")));
  EXPECT_THAT(run({"line", "--tcp", "192.0.2.7:0"}), testing::Pair(69, HasSubstr("cannot listen on")));
  EXPECT_THAT(run({"nmea", "--pty", "--fault", "disconnect@1+2"}), testing::Pair(64, HasSubstr("unplug")));
}

}  // namespace
}  // namespace yuragi::simulators::text
