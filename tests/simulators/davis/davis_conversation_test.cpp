// Conversations between separate programs, in real time: the driver davis with yuragi-sim's console over a pseudo
// terminal and TCP.
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/child_process.hpp"
#include "tests/support/driver_named.hpp"
#include "tests/support/free_port.hpp"
#include "tests/support/live_sensor.hpp"
#include "tests/support/places.hpp"
#include "tests/support/temporary_folder.hpp"

namespace yuragi::simulators::davis {
namespace {

using testing::HasSubstr;

std::vector<std::string> console_command(const std::vector<std::string>& options) {
  std::vector<std::string> command = {test::built_path("bin/yuragi-sim"),
                                      "davis",
                                      "--speed",
                                      "7.15264",
                                      "--direction",
                                      "123",
                                      "--turbulence",
                                      "0",
                                      "--interval",
                                      "0.2"};
  command.insert(command.end(), options.begin(), options.end());
  return command;
}

void expect_the_wind(const RecordingSink& sink) {
  ASSERT_FALSE(sink.readings.empty());
  for (const wind::Reading& reading : sink.readings) {
    EXPECT_NEAR(reading.speed_m_s, 16 * 0.44704, 1e-9);
    EXPECT_EQ(reading.direction_deg, 123.0);
  }
}

TEST(DavisConversation, AgreesOnTheWindOverASerialPort) {
  const test::TemporaryFolder folder;
  const std::string link = (folder / "console").string();
  ChildProcess simulator(console_command({"--pty", "--link", link}));
  simulator.line_after("listening on ");
  test::LiveSensor live(driver_named("davis").open(values_for("davis", {{"device", link}})));
  ASSERT_TRUE(live.wait_for_readings(5)) << live.sink.last_detail();
  expect_the_wind(live.sink);
  EXPECT_TRUE(live.sink.readings.back().gust_m_s.has_value());
  EXPECT_THAT(live.sink.last_detail(), HasSubstr("Davis console (LOOP2) at "));
}

TEST(DavisConversation, AgreesOnTheWindOverTcpWithOldFirmware) {
  ChildProcess simulator(console_command({"--tcp", "127.0.0.1:0", "--old-firmware"}));
  const std::string place = simulator.line_after("listening on ");
  test::LiveSensor live(driver_named("davis").open(
      values_for("davis", {{"transport", std::string("tcp")},
                           {"host", std::string("127.0.0.1")},
                           {"port", std::int64_t{std::stoi(place.substr(place.rfind(':') + 1))}}})));
  ASSERT_TRUE(live.wait_for_readings(5)) << live.sink.last_detail();
  expect_the_wind(live.sink);
  EXPECT_THAT(live.sink.last_detail(), HasSubstr("Davis console (LOOP) at "));
}

TEST(DavisConversation, AgreesOnTheWindOfAWeatherLinkLive) {
  const std::int64_t udp_port = free_port(SOCK_DGRAM);
  ChildProcess simulator({test::built_path("bin/yuragi-sim"), "weatherlink-live", "--tcp", "127.0.0.1:0", "--udp",
                          "127.0.0.1:" + std::to_string(udp_port), "--interval", "0.2", "--speed", "7.15264",
                          "--direction", "123", "--turbulence", "0"});
  const std::string place = simulator.line_after("listening on ");
  test::LiveSensor live(
      driver_named("weatherlink")
          .open(values_for("weatherlink", {{"host", std::string("127.0.0.1")},
                                           {"http_port", std::int64_t{std::stoi(place.substr(place.rfind(':') + 1))}},
                                           {"port", udp_port}})));
  ASSERT_TRUE(live.wait_for_readings(8)) << live.sink.last_detail();
  expect_the_wind(live.sink);
}

}  // namespace
}  // namespace yuragi::simulators::davis
