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

/// The same of a CAN interface.
std::string can_line(const std::string& address, const std::string& reference) {
  return "can0 09FD02" + address + "#641E01C8F1" + reference + "FFFF\n";
}
constexpr std::string_view kBusOffLine = "can0 20000040#0000000000000000\n";
constexpr std::string_view kPassiveLine = "can0 20000004#0010000000000000\n";

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

TEST_F(Nmea2000SensorTest, ReceivesTheWindAloneFromACanInterface) {
  const auto settings = [](ParameterValues::Map given) {
    given["transport"] = std::string("can");
    return nmea2000_sensor_settings_of(values_for("nmea2000", given));
  };
  const bus::BytePortAddress address = settings({}).text.address;
  EXPECT_EQ(address.kind, bus::BytePortKind::kCan);
  EXPECT_EQ(address.path, "can0");
  EXPECT_EQ(bus::sole_device_of(address), "") << "any number of sensors may listen to a bus";
  const auto passes = [&](std::uint32_t identifier) {
    return (identifier & address.can.mask) == (address.can.identifier & address.can.mask);
  };
  EXPECT_TRUE(passes(0x09FD0205));
  EXPECT_TRUE(passes(0x1DFD02FE)) << "another priority, another device";
  EXPECT_FALSE(passes(0x09FD0305)) << "PGN 130307";
  EXPECT_FALSE(passes(0x08FD0205)) << "another data page";
  EXPECT_EQ(settings({{"interface", std::string("vcan1")}}).text.address.path, "vcan1");
  EXPECT_EQ(settings({{"format", std::string("canboat")}}).lines.format, decode::marine::BusLineFormat::kCandump)
      << "it has but one";
  EXPECT_THROW(settings({{"interface", std::string()}}), std::runtime_error);
  EXPECT_THROW(settings({{"poll_interval", 1.0}}), std::runtime_error);
}

TEST_F(Nmea2000SensorTest, TellsWhatTheControllerOfACanInterfaceSays) {
  make({{"transport", std::string("can")}});
  const auto say_for_5_s = [this](const std::string& line) {
    sink.readings.clear();
    for (int i = 0; i < 10; ++i) {
      receive(line);
      run(250ms);
    }
  };
  say_for_5_s(can_line("23", "FA"));
  EXPECT_EQ(sink.readings.size(), 10U);
  EXPECT_THAT(sink.last_detail(), HasSubstr("wind apparent of device 35 at CAN interface can0"));

  receive(kPassiveLine);
  say_for_5_s(can_line("23", "FA"));
  EXPECT_EQ(sink.readings.size(), 10U) << "it still receives";
  EXPECT_EQ(sink.last_state(), wind::LinkState::kConnected);
  EXPECT_THAT(sink.last_detail(), HasSubstr("over a bus with many errors"));
  run(5s);
  EXPECT_EQ(sink.last_state(), wind::LinkState::kConnecting);
  EXPECT_THAT(sink.last_detail(), HasSubstr("error passive"));

  receive(kBusOffLine);
  run(4s);
  EXPECT_EQ(sink.last_state(), wind::LinkState::kConnecting);
  EXPECT_THAT(sink.last_detail(), HasSubstr("CAN interface can0 has left the bus after too many errors (bus off)"));
  EXPECT_EQ(sink.count(decode::Refusal::kException), 2);
  say_for_5_s(can_line("23", "FA"));
  EXPECT_EQ(sink.last_state(), wind::LinkState::kConnected);
  run(5s);
  EXPECT_THAT(sink.last_detail(), HasSubstr("terminators and bit rate of the bus")) << "the bus was there again";
}

TEST_F(Nmea2000SensorTest, ReadsCandumpsLinesWithoutBeingTold) {
  make({{"transport", std::string("tcp")}, {"host", std::string("gateway")}});
  receive("(1436509052.249713) " + can_line("23", "FA"));
  receive("  can0  09FD0223   [8]  64 1E 01 C8 F1 FA FF FF\n");
  EXPECT_EQ(sink.readings.size(), 2U);
  EXPECT_TRUE(sink.refusals.empty());
}

TEST_F(Nmea2000SensorTest, NamesTheFormatsIfNoneFits) {
  const auto detail_after = [this](ParameterValues::Map given, const std::string& line) {
    given["transport"] = std::string("tcp");
    given["host"] = std::string("gateway");
    make(std::move(given));
    for (int i = 0; i < 20; ++i) {
      receive(line);
      run(250ms);
    }
    return sink.last_detail();
  };
  const std::string depth = "2018-02-14T15:55:07.944Z,3,128267,3,255,8,09,44,00,3b,a0,fa,ff,ff\n";
  EXPECT_THAT(detail_after({}, depth), HasSubstr("PGN 130306 is on the bus"));
  EXPECT_GT(sink.count(decode::Refusal::kNotMine), 10);
  EXPECT_THAT(detail_after({}, "$WIMWV,230.6,R,3.42,M,A*12\n"), HasSubstr("set driver = \"nmea\""));
  const std::string unknown = detail_after({}, "W;230.6;3.42\n");
  EXPECT_THAT(unknown, HasSubstr("in no format of NMEA 2000 that is read (the first: \"W;230.6"));
  EXPECT_THAT(unknown, HasSubstr("yacht-devices, canboat, candump, canboat-plain, actisense"));
  EXPECT_THAT(unknown, testing::Not(HasSubstr("cable")));
  const std::string other = detail_after({{"format", std::string("yacht-devices")}}, depth);
  EXPECT_THAT(other, HasSubstr("in the format canboat-plain, not yacht-devices"));
  EXPECT_THAT(other, HasSubstr("set format = \"auto\""));
}

TEST_F(Nmea2000SensorTest, ReadsCanboatsPlainLinesAndActisensesWithoutBeingTold) {
  make({{"transport", std::string("tcp")}, {"host", std::string("gateway")}});
  receive("2016-02-28T19:57:02.364Z,2,130306,35,255,8,f7,df,01,67,00,fa,ff,ff\r\n");
  run(500ms);
  receive("A173321.107 23FF2 1FD02 F7DF016700FAFFFF\r\n");
  run(500ms);
  receive("1597516803000;A;2020-08-15T18:40:03.000Z,2,130306,35,255,8,f7,df,01,67,00,fa,ff,ff\n");
  ASSERT_EQ(sink.readings.size(), 3U);
  for (const wind::Reading& reading : sink.readings) EXPECT_NEAR(reading.speed_m_s, 4.79, 1e-9);
  EXPECT_TRUE(sink.refusals.empty());
}

}  // namespace
}  // namespace yuragi::drivers::text
