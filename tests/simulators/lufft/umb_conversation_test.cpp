// Conversations between separate programs, in real time: the driver umb with yuragi-sim's station over a pseudo
// terminal and TCP.
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/child_process.hpp"
#include "tests/support/driver_named.hpp"
#include "tests/support/live_sensor.hpp"
#include "tests/support/places.hpp"
#include "tests/support/temporary_folder.hpp"

namespace yuragi::simulators::lufft {
namespace {

using testing::HasSubstr;

std::vector<std::string> station_command(const std::vector<std::string>& options) {
  std::vector<std::string> command = {
      test::built_path("bin/yuragi-sim"), "umb", "--speed", "7.25", "--direction", "123", "--turbulence", "0"};
  command.insert(command.end(), options.begin(), options.end());
  return command;
}

void expect_the_wind(const RecordingSink& sink) {
  ASSERT_FALSE(sink.readings.empty());
  for (const wind::Reading& reading : sink.readings) {
    EXPECT_NEAR(reading.speed_m_s, 7.25, 1e-6);
    EXPECT_NEAR(reading.direction_deg.value_or(-1.0), 123.0, 1e-4);
  }
}

TEST(UmbConversation, AgreesOnTheWindOverASerialPortThatEchoes) {
  const test::TemporaryFolder folder;
  const std::string link = (folder / "station").string();
  ChildProcess simulator(station_command({"--pty", "--link", link, "--echo"}));
  simulator.line_after("listening on ");
  test::LiveSensor live(driver_named("umb").open(values_for("umb", {{"device", link}, {"poll_interval", 0.2}})));
  ASSERT_TRUE(live.wait_for_readings(5)) << live.sink.last_detail();
  expect_the_wind(live.sink);
  EXPECT_THAT(live.sink.last_detail(), HasSubstr("Lufft 7001h at "));
}

TEST(UmbConversation, AgreesOnTheWindOfAVentusOverTcp) {
  ChildProcess simulator(
      station_command({"--tcp", "127.0.0.1:0", "--class", "8", "--id", "7", "--without-fast", "--only-wind"}));
  const std::string place = simulator.line_after("listening on ");
  test::LiveSensor live(
      driver_named("umb").open(values_for("umb", {{"transport", std::string("tcp")},
                                                  {"host", std::string("127.0.0.1")},
                                                  {"port", std::int64_t{std::stoi(place.substr(place.rfind(':') + 1))}},
                                                  {"class", std::int64_t{8}},
                                                  {"id", std::int64_t{7}},
                                                  {"poll_interval", 0.2}})));
  ASSERT_TRUE(live.wait_for_readings(5)) << live.sink.last_detail();
  expect_the_wind(live.sink);
  EXPECT_THAT(live.sink.last_detail(), HasSubstr("Lufft 8007h at "));
}

}  // namespace
}  // namespace yuragi::simulators::lufft
