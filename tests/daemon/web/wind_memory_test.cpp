#include "daemon/web/wind_memory.hpp"

#include <gtest/gtest.h>

namespace yuragi::daemon::web {
namespace {

using wind::judging::SensorState;

wire::SensorStatus sensor(SensorState state, std::optional<double> speed_m_s) {
  wire::SensorStatus made;
  made.state = state;
  made.speed_m_s = speed_m_s;
  return made;
}

TEST(WindMemory, ShowsTheMostRealSensorThatIsBelievedAndHasASpeed) {
  wire::Sensors sensors;
  EXPECT_EQ(measured_speed_m_s(sensors), std::nullopt);
  sensors.sensors = {sensor(SensorState::kStale, 1.0), sensor(SensorState::kSimulated, 2.0)};
  EXPECT_EQ(measured_speed_m_s(sensors), 2.0);
  sensors.sensors.push_back(sensor(SensorState::kReplayed, 3.0));
  sensors.sensors.push_back(sensor(SensorState::kLive, std::nullopt));
  EXPECT_EQ(measured_speed_m_s(sensors), 3.0);
  sensors.sensors.push_back(sensor(SensorState::kLive, 4.0));
  sensors.sensors.push_back(sensor(SensorState::kLive, 5.0));
  EXPECT_EQ(measured_speed_m_s(sensors), 4.0);
}

TEST(WindMemory, KeepsThreeMinutesAtAMomentASecondHoweverOftenNewsCome) {
  WindMemory memory;
  wire::Sensors sensors;
  sensors.wind.live_weight = 0.75;
  for (int i = 0; i < 4 * 1000; ++i) {
    sensors.sensors = {sensor(SensorState::kLive, 0.25 * i)};
    memory.add(0.25 * i, sensors);
  }
  ASSERT_GE(memory.moments().size(), 170U);
  EXPECT_LE(memory.moments().size(), 201U);
  EXPECT_GE(memory.moments().front().mono_s, 999.75 - WindMemory::kLength_s - 1.0);
  EXPECT_NEAR(memory.moments().back().mono_s, 999.75, 1.0);
  double before_s = 0.0;
  for (const WindMoment& moment : memory.moments()) {
    EXPECT_GT(moment.mono_s, before_s);
    EXPECT_EQ(moment.measured_m_s, moment.mono_s);
    EXPECT_DOUBLE_EQ(moment.noise_share, 0.25);
    before_s = moment.mono_s;
  }
}

TEST(WindMemory, HasAGapInWhatIsMeasuredWhileNoSensorIsBelieved) {
  WindMemory memory;
  wire::Sensors sensors;
  sensors.sensors = {sensor(SensorState::kDisconnected, 4.0)};
  memory.add(10.0, sensors);
  ASSERT_EQ(memory.moments().size(), 1U);
  EXPECT_EQ(memory.moments()[0].measured_m_s, std::nullopt);
}

}  // namespace
}  // namespace yuragi::daemon::web
