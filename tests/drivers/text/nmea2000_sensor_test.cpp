#include "drivers/text/nmea2000_sensor.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/scripted_text.hpp"

namespace yuragi::drivers::text {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;

/// Lines of 2.86 m/s from 354.6 degrees, of a device and a reference.
std::string yacht_line(const std::string& address, const std::string& reference) {
  return "17:33:21.179 R 09FD02" + address + " 64 1E 01 C8 F1 " + reference + " FF FF\r\n";
}
std::string canboat_angle(const std::string& angle) {
  return R"({"src":7,"pgn":130306,"fields":{"Wind Speed":5.0,"Wind Angle":)" + angle + R"(,"Reference":"Apparent"}})" +
         "\n";
}

class Nmea2000SensorTest : public testing::Test, protected ScriptedText {
 protected:
  void make(ParameterValues::Map given = {}) {
    sink = {};
    given.try_emplace("device", std::string("/dev/script"));
    sensor = std::make_unique<Nmea2000Sensor>(nmea2000_sensor_settings_of(values_for("nmea2000", given)),
                                              std::make_unique<ScriptedPort>(far_end, clock));
  }
};

TEST_F(Nmea2000SensorTest, PublishesOneWindOfABurstOnceAndPrefersNorth) {
  make();
  for (int second = 0; second < 10; ++second) {
    far_end.send(yacht_line("23", "FA"));
    far_end.send(yacht_line("23", "FB"));
    receive(yacht_line("23", "F8"));
    run(750ms);
  }
  EXPECT_EQ(sink.readings.size(), 10U);
  EXPECT_TRUE(sink.refusals.empty());
  EXPECT_THAT(sink.last_detail(), HasSubstr("wind north of device 35"));
}

TEST_F(Nmea2000SensorTest, TakesTheDeviceAndTheReferenceThatItIsTold) {
  make({{"address", std::int64_t{0x24}}});
  receive(yacht_line("23", "FA"));
  EXPECT_TRUE(sink.readings.empty());
  receive(yacht_line("24", "FA"));
  EXPECT_EQ(sink.readings.size(), 1U);

  make({{"reference", std::string("true")}});
  receive(yacht_line("23", "FA"));
  EXPECT_EQ(sink.count(decode::Refusal::kNotMine), 1);
  receive(yacht_line("23", "FC"));
  EXPECT_EQ(sink.readings.size(), 1U);
}

TEST_F(Nmea2000SensorTest, TurnsDirectionsByTheMarkAndTheVariation) {
  const auto direction_of = [this](const std::string& reference) {
    make({{"north_offset", 10.0}, {"variation", -4.0}});
    receive(yacht_line("23", reference));
    return sink.readings.at(0).direction_deg.value();
  };
  EXPECT_NEAR(direction_of("FA"), 4.638, 0.001);
  EXPECT_NEAR(direction_of("F9"), 350.638, 0.001);
  EXPECT_NEAR(direction_of("F8"), 354.638, 0.001);
}

TEST_F(Nmea2000SensorTest, HasNoDirectionUntilTheUnitOfAnglesIsKnown) {
  make();
  receive(canboat_angle("2.0"));
  ASSERT_EQ(sink.readings.size(), 1U);
  EXPECT_FALSE(sink.readings[0].direction_deg) << "radians or degrees?";
  EXPECT_THAT(sink.last_detail(), HasSubstr("angle_unit"));
  receive(canboat_angle("200.0"));
  receive(canboat_angle("2.0"));
  ASSERT_EQ(sink.readings.size(), 3U);
  EXPECT_EQ(sink.readings[2].direction_deg, 2.0) << "degrees: a gust before it said so";

  make();
  receive("{\"version\":\"4.12.0\",\"units\":\"si\"}\n");
  receive(canboat_angle("2.0"));
  EXPECT_NEAR(sink.readings.at(0).direction_deg.value(), 114.592, 0.001);
  make({{"angle_unit", std::string("deg")}});
  receive(canboat_angle("2.0"));
  EXPECT_EQ(sink.readings.at(0).direction_deg, 2.0);
}

TEST_F(Nmea2000SensorTest, ReadsOnAmongLongRecordsOfOtherMessages) {
  make({{"transport", std::string("tcp")}, {"host", std::string("gateway")}});
  for (int second = 0; second < 10; ++second) {
    far_end.send(R"({"src":1,"pgn":129540,"fields":{"list":")" + std::string(4000, 'x') + "\"}}\n");
    receive(canboat_angle("200.0"));
    run(750ms);
  }
  EXPECT_EQ(sink.readings.size(), 10U);
  EXPECT_EQ(sink.count(decode::Refusal::kNotMine), 10);
  EXPECT_EQ(sink.last_state(), wind::LinkState::kConnected);
}

}  // namespace
}  // namespace yuragi::drivers::text
