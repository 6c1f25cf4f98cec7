#include "daemon/tools/sensors/sensor_table.hpp"

#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace yuragi::daemon::tools::sensors {
namespace {

using ::testing::ContainsRegex;
using ::testing::HasSubstr;
using ::testing::Not;

TEST(SensorTable, ShowsWindStateValuesAndRefusals) {
  wire::SensorStatus live;
  live.name = "roof";
  live.driver = "modbus";
  live.link = wind::LinkState::kConnected;
  live.health = wind::SourceHealth::kLive;
  live.state = wind::judging::SensorState::kLive;
  live.state_reason = "a reading every 0.5 s";
  live.value = "instantaneous (assumed)";
  live.reads_times_group = 1.21;
  live.detail = "answers at 10.0.0.5:502";
  live.speed_m_s = 8.6;
  live.direction_deg = 90.0;
  live.age_s = 0.2;
  live.interval_s = 0.5;
  live.readings = 42;
  live.refused = {{"timeout", 3}, {"exception", 1}};
  wire::SensorStatus silent;
  silent.name = "mast";
  silent.driver = "modbus";
  const wire::Sensors sensors{
      .sensors = {live, silent},
      .wind = {.time = {}, .wind = {5.0, 0.0}, .source = wind::Source::kLive, .live_weight = 1.0, .reading_age_s = 0.2},
      .late_ticks = 40,
      .clients = 3,
      .recent_ticks = 36'000,
      .recent_skipped_ticks = 2};

  const std::string table = sensor_table(sensors);
  EXPECT_THAT(table, HasSubstr("wind 5.0 m/s from 270 W (live)   clients 3   ticks skipped 2"));
  EXPECT_THAT(table, HasSubstr("roof"));
  EXPECT_THAT(table, HasSubstr("8.60"));
  EXPECT_THAT(table, HasSubstr(" 90 E"));
  EXPECT_THAT(table, HasSubstr("timeout 3, exception 1"));
  EXPECT_THAT(table, HasSubstr("connected: answers at 10.0.0.5:502"));
  EXPECT_THAT(table, HasSubstr("live: a reading every 0.5 s"));
  EXPECT_THAT(table, HasSubstr("speed: instantaneous (assumed)"));
  EXPECT_THAT(table, HasSubstr("reads 1.21 times the group"));
  EXPECT_EQ(table.find("times the group", table.find("mast")), std::string::npos) << "nothing is known";
  EXPECT_THAT(table, HasSubstr("connecting")) << "a sensor that never spoke shows what its link does";
}

TEST(SensorTable, ShowsHowTheDaemonDoesInOneLine) {
  wire::Sensors sensors;
  EXPECT_THAT(sensor_table(sensors), Not(HasSubstr("since the start"))) << "without a daemon, or by an old one";
  sensors.refused_clients = 2;
  sensors.stuck_clients = 1;
  sensors.io_lateness = wire::Lateness{.p50_s = 6e-5, .p99_s = 2e-4, .max_s = 0.0125};
  EXPECT_THAT(sensor_table(sensors), HasSubstr("  since the start: clients refused 2, stuck 1, idle 0; "
                                               "late in the last 10 min (p50, p99, most): I/O 0.06, 0.20, 12.50 ms\n"));
  sensors.tick_lateness = wire::Lateness{.p50_s = 1e-4, .p99_s = 3e-4, .max_s = 2.9e-4};
  EXPECT_THAT(sensor_table(sensors), HasSubstr("; ticks 0.10, 0.29, 0.29 ms\n"));
}

TEST(SensorTable, ShowsHowTheRecordingDoes) {
  wire::Sensors sensors;
  EXPECT_THAT(sensor_table(sensors), Not(HasSubstr("recorded")));
  sensors.recorder = wire::RecorderStatus{.written = 1200, .waiting = 3, .free_bytes = 2'340'000'000};
  EXPECT_THAT(sensor_table(sensors), HasSubstr("recorded 1200 readings, waiting 3, lost 0; 2.3 GB free\n"));
  sensors.recorder =
      wire::RecorderStatus{.state = wire::RecorderState::kHanging, .error = "a.windlog: the disk does not respond"};
  EXPECT_THAT(sensor_table(sensors), HasSubstr("HANGS: a.windlog: the disk does not respond\n"));
  sensors.recorder->state = wire::RecorderState::kRetrying;
  EXPECT_THAT(sensor_table(sensors), HasSubstr("CANNOT WRITE, trying again: a.windlog"));
}

TEST(SensorTable, NobodyTakesAReplayForTheWindOfNow) {
  wire::SensorStatus log;
  log.name = "storm";
  log.driver = "windlog";
  log.link = wind::LinkState::kConnected;
  log.health = wind::SourceHealth::kLive;
  log.replayed = true;
  log.state = wind::judging::SensorState::kReplayed;
  log.readings = 3;
  wire::Sensors sensors{
      {log},
      {.time = {}, .wind = {5.0, 0.0}, .source = wind::Source::kLive, .live_weight = 1.0, .reading_age_s = 0.0},
      0,
      0};
  EXPECT_THAT(sensor_table(sensors), HasSubstr("(REPLAY of a recording)"));
  EXPECT_THAT(sensor_table(sensors), ContainsRegex("storm +windlog +REPLAY"));
  log.replayed = false;
  log.state = wind::judging::SensorState::kLive;
  sensors.sensors.push_back(log);
  EXPECT_THAT(sensor_table(sensors), HasSubstr("(live)")) << "a real one speaks beside it";
}

TEST(SensorTable, SaysWhereTheWindIsAndWhenItsGustsComeToTheMiddle) {
  wire::Sensors sensors;
  EXPECT_THAT(sensor_table(sensors), Not(HasSubstr("middle"))) << "nothing is said of a wind without a place";
  sensors.wind = {.wind = {7.2, 0.0}, .upwind_m = 5.0, .to_middle_s = 0.694};
  EXPECT_THAT(
      sensor_table(sensors),
      HasSubstr("\n  at the windward edge, 5.0 m upwind of the middle of the scenes; a gust reaches it in 0.7 s\n"));
  sensors.wind = {.wind = {3.0, 0.0}, .upwind_m = 42.4, .to_middle_s = 14.1, .is_place_configured = true};
  EXPECT_THAT(sensor_table(sensors),
              HasSubstr("\n  at the sensors, 42 m upwind of the middle of the scenes; a gust reaches it in 14 s\n"));
  sensors.wind = {.wind = {3.0, 0.0}, .upwind_m = -12.0, .to_middle_s = 0.0, .is_place_configured = true};
  EXPECT_THAT(sensor_table(sensors), HasSubstr("\n  at the sensors, 12 m downwind of the middle of the scenes\n"));
  sensors.wind.upwind_m = 0.0;
  EXPECT_THAT(sensor_table(sensors), HasSubstr("\n  at the sensors, level with the middle of the scenes\n"));
}

TEST(SensorTable, SaysHowFarGustsAreAlikeWhereThatIsKnown) {
  wire::Sensors sensors;
  EXPECT_THAT(sensor_table(sensors), Not(HasSubstr("alike")));
  sensors.gust_reach_across = 1.4;
  EXPECT_THAT(
      sensor_table(sensors),
      HasSubstr("\n  gusts are alike 1.40 times as far across the wind as usually; learnt from these sensors\n"));
  sensors.gust_reach_along = 0.8;
  EXPECT_THAT(sensor_table(sensors),
              HasSubstr("alike 1.40 times as far across the wind and 0.80 times as far along the"));
}

TEST(SensorTable, SaysHowTheWindIsShapedWhereItIs) {
  wire::Sensors sensors;
  EXPECT_THAT(sensor_table(sensors), Not(HasSubstr("shaped")));
  sensors.shaping.text = "floor: raised 0.6 to 1.5 m/s; closed until 10:00";
  EXPECT_THAT(sensor_table(sensors), HasSubstr("\n  shaped: floor: raised 0.6 to 1.5 m/s; closed until 10:00\n"));
}

TEST(SensorTable, ShowsFramesAndReconnects) {
  wire::SensorStatus sensor;
  sensor.name = "roof";
  sensor.readings = 1200;
  sensor.frames = 34567;
  sensor.reconnects = 12;
  EXPECT_THAT(sensor_table({{sensor}, {}, 0, 0}), ContainsRegex(" 34567 +1200 +12\n"));
}

TEST(SensorTable, StaysWithinAHundredColumnsAndKeepsEveryWord) {
  wire::SensorStatus sensor;
  sensor.name = "a sensor with a name that is long";
  sensor.driver = "a driver with a long name";
  sensor.health = wind::SourceHealth::kLive;
  sensor.state = wind::judging::SensorState::kDisconnected;
  sensor.state_reason =
      "a reason of many words, which goes on and on and on, until it is longer than any line may be here";
  sensor.detail =
      "slave 1 at /dev/serial/by-id/usb-FTDI_FT232R_USB_UART_A50285BI-if00-port0 does not answer within 0.5 s: check "
      "its "
      "power, its wiring and its id, and that nobody else asks on its line";
  sensor.speed_m_s = 120.0;
  sensor.direction_deg = 247.5;
  sensor.gust_m_s = 119.99;
  sensor.age_s = 99999.9;
  sensor.interval_s = 3600.0;
  sensor.frames = 999'999'999;
  sensor.readings = 999'999'999;
  sensor.reconnects = 99'999;
  for (const char* why : {"timeout", "too short", "not mine", "bad checksum", "exception", "malformed", "invalid"}) {
    sensor.refused.emplace_back(why, 123'456'789);
  }
  const std::string table = sensor_table({{sensor}, {}, 0, 0});
  std::istringstream lines(table);
  std::string words;
  for (std::string line; std::getline(lines, line);) {
    EXPECT_LE(line.size(), 100U) << line;
    if (!line.empty()) words += line.substr(line.find_first_not_of(' ')) + " ";
  }
  EXPECT_THAT(words, HasSubstr(sensor.detail));
  EXPECT_THAT(words, HasSubstr(sensor.state_reason));
  EXPECT_THAT(words, HasSubstr("bad checksum 123456789, exception 123456789"));
}

TEST(SensorTable, AStaleSensorCannotBeTakenForALiveOne) {
  wire::SensorStatus stale;
  stale.name = "roof";
  stale.health = wind::SourceHealth::kStale;
  stale.state = wind::judging::SensorState::kStale;
  stale.speed_m_s = 3.0;
  EXPECT_THAT(sensor_table({{stale}, {}, 0, 0}), HasSubstr("STALE"));
}

TEST(SensorTable, EachStateIsShownAndTroubleInCapitals) {
  for (std::size_t number = 0; number < wind::judging::kSensorStateNames.size(); ++number) {
    wire::SensorStatus sensor;
    sensor.name = "roof";
    sensor.driver = "hid";
    sensor.state = static_cast<wind::judging::SensorState>(number);
    sensor.state_reason = "for a reason";
    const std::string table = sensor_table({{sensor}, {}, 0, 0});
    EXPECT_THAT(table, HasSubstr(std::string(wind::judging::kSensorStateNames[number]) + ": for a reason"));
  }
  wire::SensorStatus frozen;
  frozen.name = "roof";
  frozen.driver = "hid";
  frozen.state = wind::judging::SensorState::kFrozen;
  EXPECT_THAT(sensor_table({{frozen}, {}, 0, 0}), ContainsRegex("roof +hid +FROZEN"));
}

TEST(SensorTable, AReasonThatIsTheLinksOwnIsToldOnce) {
  wire::SensorStatus lost;
  lost.name = "roof";
  lost.state = wind::judging::SensorState::kDisconnected;
  lost.state_reason = lost.detail = "/dev/ttyUSB0 has gone";
  const std::string table = sensor_table({{lost}, {}, 0, 0});
  EXPECT_EQ(table.find("has gone"), table.rfind("has gone")) << table;
}

}  // namespace
}  // namespace yuragi::daemon::tools::sensors
