#include "daemon/sensor_table.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace yuragi {
namespace {

using ::testing::HasSubstr;

TEST(SensorTable, NamesTheCompassPoints) {
  EXPECT_EQ(compass_point(0.0), "N");
  EXPECT_EQ(compass_point(359.0), "N");
  EXPECT_EQ(compass_point(90.0), "E");
  EXPECT_EQ(compass_point(247.5), "WSW");
  EXPECT_EQ(compass_point(-22.5), "NNW");
}

TEST(SensorTable, ShowsWindStateValuesAndRefusals) {
  wire::SensorStatus live;
  live.name = "roof";
  live.driver = "modbus";
  live.link = 1;
  live.health = 1;
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
      {live, silent},
      {.time = {}, .wind = {5.0, 0.0}, .source = WindSource::kLive, .live_weight = 1.0, .reading_age_s = 0.2},
      2,
      3};

  const std::string table = sensor_table(sensors);
  EXPECT_THAT(table, HasSubstr("wind 5.0 m/s from 270 W (live)   clients 3   late ticks 2"));
  EXPECT_THAT(table, HasSubstr("roof"));
  EXPECT_THAT(table, HasSubstr("8.60"));
  EXPECT_THAT(table, HasSubstr(" 90 E"));
  EXPECT_THAT(table, HasSubstr("timeout 3, exception 1"));
  EXPECT_THAT(table, HasSubstr("connected: answers at 10.0.0.5:502"));
  EXPECT_THAT(table, HasSubstr("connecting")) << "a sensor that never spoke shows what its link does";
}

TEST(SensorTable, AStaleSensorCannotBeTakenForALiveOne) {
  wire::SensorStatus stale;
  stale.name = "roof";
  stale.health = 2;
  stale.speed_m_s = 3.0;
  EXPECT_THAT(sensor_table({{stale}, {}, 0, 0}), HasSubstr("STALE"));
}

}  // namespace
}  // namespace yuragi
