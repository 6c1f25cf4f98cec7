// Frames and lines as the makers and projects print them: Yacht Devices YDNU-02 manual, appendix E; can-utils lib.h;
// canboat (samples of a WS320 and of an Actisense NGT-1) and canboatjs tests; the Signal K specification.
#include <array>
#include <string>

#include <gtest/gtest.h>

#include "drivers/decode/marine/actisense.hpp"
#include "drivers/decode/marine/bus_frame.hpp"
#include "drivers/decode/marine/bus_line.hpp"
#include "drivers/decode/marine/canboat.hpp"
#include "drivers/decode/marine/canboat_plain.hpp"
#include "drivers/decode/marine/candump.hpp"
#include "drivers/decode/marine/signalk.hpp"
#include "drivers/decode/marine/yacht_devices.hpp"
#include "engine/base/units.hpp"

namespace yuragi::drivers::decode::marine {
namespace {

template <class Decoded>
bool refuses(const Result<Decoded, Refusal>& decoded, Refusal why) {
  return !decoded && decoded.error() == why;
}

/// A line of Yacht Devices with these data bytes of PGN 130306.
Result<BusWind, Refusal> wind_of_bytes(const std::string& bytes) {
  return decode_yacht_devices("17:33:21.179 R 09FD0205 " + bytes);
}

Result<BusWind, Refusal> wind_of_fields(const std::string& fields, std::optional<AngleUnit> unit) {
  return decode_canboat({.angle_unit = unit}, R"({"prio":2,"src":7,"dst":255,"pgn":130306,"fields":{)" + fields + "}}");
}

/// A delta of one update with these values.
std::string delta(const std::string& values, const std::string& head = R"("$source":"n2k.105")") {
  return R"({"context":"vessels.self","updates":[{)" + head + R"(,"values":[)" + values + "]}]}";
}
std::string value(const std::string& path, const std::string& number) {
  return R"({"path":"environment.wind.)" + path + R"(","value":)" + number + "}";
}

TEST(YachtDevices, GivesTheWindOfTheMakersExample) {
  const auto said = decode_yacht_devices("17:33:21.179 R 09FD0205 64 1E 01 C8 F1 FA FF FF\r\n");
  ASSERT_TRUE(said);
  EXPECT_EQ(said->address, 5);
  EXPECT_EQ(said->reference, WindDataReference::kApparent);
  EXPECT_NEAR(*said->wind.speed_m_s, 2.86, 1e-9);
  EXPECT_NEAR(*said->wind.direction_deg, 6.1896 / kRadPerDeg, 1e-9);
  EXPECT_EQ(said->wind.reference, WindReference::kRelative);
  EXPECT_EQ(said->wind.status, DecodedStatus::kGood);
}

TEST(YachtDevices, PassesOverTheOtherMessagesOfTheMakersExample) {
  for (const char* line :
       {"17:33:21.107 R 19F51323 01 2F 30 70 00 2F 30 70", "17:33:21.108 R 19F51323 02 00",
        "17:33:21.141 R 09F80115 A0 7D E6 18 C0 05 FB D5", "17:33:21.189 R 1DEFFF00 A0 0B E5 98 F1 08 02 02",
        "17:33:21.190 R 1DEFFF00 A1 00 DF 83 00 00", "17:33:21.219 R 15FD0734 FF 02 2B 75 A9 1A FF FF"}) {
    EXPECT_TRUE(refuses(decode_yacht_devices(line), Refusal::kNotMine)) << line;
    EXPECT_TRUE(looks_like_yacht_devices(line)) << line;
  }
  EXPECT_TRUE(refuses(decode_yacht_devices("17:33:21.179 T 09FD0205 64 1E 01 C8 F1 FA FF FF"), Refusal::kNotMine))
      << "sent by a program, not by the bus";
}

TEST(YachtDevices, KnowsEachReference) {
  const std::array<std::pair<const char*, WindReference>, 6> references = {{{"F8", WindReference::kNorth},
                                                                            {"F9", WindReference::kMagnetic},
                                                                            {"FA", WindReference::kRelative},
                                                                            {"FB", WindReference::kTrue},
                                                                            {"FC", WindReference::kTrue},
                                                                            {"FF", WindReference::kUnknown}}};
  for (const auto& [byte, reference] : references) {
    const auto said = wind_of_bytes(std::string("64 1E 01 C8 F1 ") + byte + " FF FF");
    ASSERT_TRUE(said) << byte;
    EXPECT_EQ(said->wind.reference, reference) << byte;
  }
  EXPECT_TRUE(refuses(wind_of_bytes("64 1E 01 C8 F1 FD FF FF"), Refusal::kMalformed));
  EXPECT_TRUE(refuses(wind_of_bytes("64 1E 01 C8 F1 FE FF FF"), Refusal::kMalformed));
}

TEST(YachtDevices, TakesMarksForNoValueAsSuch) {
  for (const char* speed : {"FD FF", "FE FF", "FF FF"}) {
    EXPECT_TRUE(refuses(wind_of_bytes("64 " + std::string(speed) + " C8 F1 FA FF FF"), Refusal::kInvalid)) << speed;
  }
  for (const char* angle : {"FD FF", "FE FF", "FF FF"}) {
    const auto said = wind_of_bytes("64 1E 01 " + std::string(angle) + " FA FF FF");
    ASSERT_TRUE(said) << angle;
    EXPECT_FALSE(said->wind.direction_deg);
    EXPECT_EQ(said->wind.status, DecodedStatus::kGood);
  }
  EXPECT_TRUE(refuses(wind_of_bytes("64 FC FF C8 F1 FA FF FF"), Refusal::kImplausible));
}

TEST(YachtDevices, LeavesTheSpeedBesideAnImpossibleAngle) {
  const auto whole = wind_of_bytes("64 1E 01 70 F5 FA FF FF");  // 62832: a whole turn, rounded up
  ASSERT_TRUE(whole && whole->wind.direction_deg);
  EXPECT_NEAR(*whole->wind.direction_deg, 0.0, 0.001);
  const auto beyond = wind_of_bytes("64 1E 01 FC FF FA FF FF");
  ASSERT_TRUE(beyond);
  EXPECT_FALSE(beyond->wind.direction_deg);
  EXPECT_NEAR(*beyond->wind.speed_m_s, 2.86, 1e-9);
  EXPECT_EQ(beyond->wind.status, DecodedStatus::kUncertain);
}

TEST(YachtDevices, ThatIsHurtIsRefused) {
  for (const char* bytes : {"64 1E 01 C8 F1", "64"}) EXPECT_TRUE(refuses(wind_of_bytes(bytes), Refusal::kTooShort));
  for (const char* bytes : {"64 1E 01 C8 F1 F", "64 1E 01 C8 F1 FA FF FF 00", "64 1E 0x C8 F1 FA FF FF",
                            "64 1E 01 C8 F1 FA FF F17:33:21.179"}) {
    EXPECT_TRUE(refuses(wind_of_bytes(bytes), Refusal::kMalformed)) << bytes;
  }
  EXPECT_TRUE(refuses(decode_yacht_devices(""), Refusal::kTooShort));
  EXPECT_TRUE(refuses(decode_yacht_devices("17:33:21.179 R 09FD0205"), Refusal::kTooShort));
  for (const char* line :
       {"17:33:21 R 09FD0205 64 1E 01 C8 F1 FA FF FF", "17:33:21.179 X 09FD0205 64 1E 01 C8 F1 FA FF FF",
        "17:33:21.179 R 9FD0205 64 1E 01 C8 F1 FA FF FF", "17:33:21.179 R 29FD0205 64 1E 01 C8 F1 FA FF FF",
        "$WIMWV, 230.6 R 3.42 M A*12"}) {
    EXPECT_TRUE(refuses(decode_yacht_devices(line), Refusal::kMalformed)) << line;
  }
}

TEST(BusIdentifier, IsTakenApart) {
  const BusIdentifier wind = bus_identifier_of(0x09FD0205);
  EXPECT_EQ(wind.priority, 2);
  EXPECT_EQ(wind.pgn, 130306U);
  EXPECT_EQ(wind.address, 5);
  const BusIdentifier to_all = bus_identifier_of(0x1DEFFF00);
  EXPECT_EQ(to_all.priority, 7);
  EXPECT_EQ(to_all.pgn, 126720U) << "its destination is no part of it";
  EXPECT_EQ(to_all.address, 0);
}

TEST(Candump, GivesTheWindInEachForm) {
  for (const char* line :
       {"can0 09FD0205#641E01C8F1FAFFFF", "(1436509052.249713) vcan0 09FD0205#641e01c8f1faffff\n",
        "(1436509052.249713) can0 09FD0205#641E01C8F1FAFFFF R", "  can0  09FD0205   [8]  64 1E 01 C8 F1 FA FF FF",
        " (000.000000)  can0  09FD0205   [8]  64 1E 01 C8 F1 FA FF FF   'd.......'"}) {
    EXPECT_TRUE(looks_like_candump(line)) << line;
    const auto said = decode_candump(line);
    ASSERT_TRUE(said) << line;
    EXPECT_EQ(said->address, 5);
    EXPECT_EQ(said->reference, WindDataReference::kApparent);
    EXPECT_NEAR(*said->wind.speed_m_s, 2.86, 1e-9);
    EXPECT_NEAR(*said->wind.direction_deg, 6.1896 / kRadPerDeg, 1e-9);
  }
}

TEST(Candump, PassesOverWhatIsNoFrameOfTheWind) {
  for (const char* line :
       {"can0 123#00", "can0 7A1#R", "can0 09FD0205#R", "can0 09FD0205##1641E01C8F1FAFFFF", "can0 09F80115#A07DE618",
        "can0  123   [3]  11 22 33", "can0  12345678  [03]  11 22 33", "can0  12345678   [0]  remote request"}) {
    EXPECT_TRUE(refuses(decode_candump(line), Refusal::kNotMine)) << line;
    EXPECT_TRUE(looks_like_candump(line)) << line;
  }
}

TEST(Candump, SaysHowTheControllerDoes) {
  EXPECT_EQ(candump_controller_state("can0 20000040#0000000000000000"), ControllerState::kBusOff);
  EXPECT_EQ(candump_controller_state("can0  20000004   [8]  00 10 00 00 00 00 80 00   ERRORFRAME"),
            ControllerState::kPassive);
  EXPECT_EQ(candump_controller_state("can0 20000004#0020000000000000"), ControllerState::kPassive);
  EXPECT_EQ(candump_controller_state("can0 20000004#0008000000000000"), ControllerState::kGood) << "warned only";
  EXPECT_EQ(candump_controller_state("can0 20000004#0040000000000000"), ControllerState::kGood);
  EXPECT_EQ(candump_controller_state("can0 20000100#0000000000000000"), ControllerState::kGood) << "started again";
  EXPECT_EQ(candump_controller_state("can0 20000004#0001000000000000"), std::nullopt) << "a frame was lost";
  EXPECT_EQ(candump_controller_state("can0 00000040#00"), std::nullopt) << "of the bus";
  EXPECT_TRUE(refuses(decode_candump("can0 20000040#0000000000000000"), Refusal::kException));
}

TEST(Candump, RefusesWhatIsNoLine) {
  for (const char* line : {"", "can0", "can0 09FD0205", "(1.0) can0 09FD0205", "can0 09FD0205 [8] 64 1E"}) {
    EXPECT_TRUE(refuses(decode_candump(line), Refusal::kTooShort)) << line;
  }
  for (const char* line :
       {"can0 09FD020#641E01C8F1FAFFFF", "can0 09FD0205#641E01C8F1FAFF0", "can0 09FD0205#641E01C8F1FAFFFF00",
        "can0 09FD0205#641E01C8F1FAFFxx", "can0 49FD0205#641E01C8F1FAFFFF",
        "can0 09FD0205 [9] 64 1E 01 C8 F1 FA FF FF 0", "can0 09FD0205 [8] 64 1E 01 C8 F1 FA FF FF FF",
        "can0 09FD0205 8 64 1E", "$WIMWV, 230.6 R 3.42 M A*12"}) {
    EXPECT_TRUE(refuses(decode_candump(line), Refusal::kMalformed)) << line;
  }
  EXPECT_TRUE(refuses(decode_candump("can0 09FD0205#641E01"), Refusal::kTooShort)) << "as decode_wind_data()";
}

TEST(Canboat, GivesTheWindInEachFormOfItsJson) {
  // In degrees, as of 2013 with texts for numbers and as of 2020; -si; -nv; -camel; canboatjs.
  for (
      const auto& [line, unit, speed_m_s, direction_deg] :
      std::vector<std::tuple<const char*, AngleUnit, double, double>>{
          {R"({"timestamp":"2013-08-22-19:11:05.607","prio":"2","src":"105","dst":"255","pgn":"130306","description":"Wind Data","fields":{"SID":"0","Wind Speed":"1.54","Wind Angle":"141.0","Reference":"Apparent"}})",
           AngleUnit::kDegrees, 1.54, 141.0},
          {R"({"timestamp":"2020-06-05-18:03:25.626","prio":2,"src":105,"dst":255,"pgn":130306,"description":"Wind Data","fields":{"SID":0,"Wind Speed":4.01,"Wind Angle":347.4,"Reference":"Apparent"}})",
           AngleUnit::kDegrees, 4.01, 347.4},
          {R"({"prio":2,"src":105,"dst":255,"pgn":130306,"description":"Wind Data","fields":{"Wind Speed":5.0,"Wind Angle":1.2,"Reference":{"value":2,"name":"Apparent"}}})",
           AngleUnit::kRadians, 5.0, 1.2 / kRadPerDeg},
          {R"({"windData":{"prio":2,"src":105,"dst":255,"pgn":130306,"description":"windData","fields":{"windSpeed":5.0,"windAngle":1.2,"reference":{"value":2,"name":"Apparent"}}}})",
           AngleUnit::kRadians, 5.0, 1.2 / kRadPerDeg},
          {R"({"canId":0,"prio":0,"src":105,"dst":255,"pgn":130306,"timestamp":"1970-01-01T00:00:00.003Z","fields":{"SID":0,"Wind Speed":2.23,"Wind Angle":0.0966,"Reference":"Apparent"},"description":"Wind Data"})",
           AngleUnit::kRadians, 2.23, 0.0966 / kRadPerDeg}}) {
    const auto said = decode_canboat({.angle_unit = unit}, line);
    ASSERT_TRUE(said) << line;
    EXPECT_EQ(said->address, 105);
    EXPECT_EQ(said->wind.reference, WindReference::kRelative);
    EXPECT_NEAR(said->wind.speed_m_s.value(), speed_m_s, 1e-9) << line;
    EXPECT_NEAR(said->wind.direction_deg.value(), direction_deg, 1e-9) << line;
  }
}

TEST(Canboat, KnowsEachReference) {
  const auto reference = [](const std::string& text) {
    const auto said = wind_of_fields(R"("Wind Speed":1.0,"Reference":)" + text, {});
    return said ? std::optional(said->reference) : std::nullopt;
  };
  EXPECT_EQ(reference(R"x("True (ground referenced to North)")x"), WindDataReference::kNorth);
  EXPECT_EQ(reference(R"x("Magnetic (ground referenced to Magnetic North)")x"), WindDataReference::kMagnetic);
  EXPECT_EQ(reference(R"x("True (boat referenced)")x"), WindDataReference::kBoat);
  EXPECT_EQ(reference(R"x("True (water referenced)")x"), WindDataReference::kWater);
  EXPECT_EQ(reference("3"), WindDataReference::kBoat);
  EXPECT_EQ(reference("null"), WindDataReference::kUnknown);
  for (const char* text : {R"("Sideways")", "5", "-1", "2.5", "[]", "{}", R"({"value":9})"}) {
    EXPECT_FALSE(reference(text)) << text;
  }
}

TEST(Canboat, GuessesNoUnitOfAnAngle) {
  EXPECT_EQ(canboat_angle_unit(R"({"version":"4.12.0","units":"std"})"), AngleUnit::kDegrees);
  EXPECT_EQ(canboat_angle_unit(R"({"version":"4.12.0","units":"si","showLookupValues":true})"), AngleUnit::kRadians);
  EXPECT_EQ(canboat_angle_unit(R"({"version":"4.12.0"})"), std::nullopt);
  EXPECT_EQ(canboat_angle_unit(R"({"pgn":130306,"units":"si"})"), std::nullopt);

  EXPECT_FALSE(wind_of_fields(R"("Wind Speed":1.0,"Wind Angle":3.0)", {})->wind.direction_deg) << "either is possible";
  EXPECT_EQ(wind_of_fields(R"("Wind Speed":1.0,"Wind Angle":300.0)", {})->wind.direction_deg, 300.0);
  EXPECT_EQ(wind_of_fields(R"("Wind Speed":1.0,"Wind Angle":3.0)", AngleUnit::kDegrees)->wind.direction_deg, 3.0);
  const auto impossible = wind_of_fields(R"("Wind Speed":1.0,"Wind Angle":300.0)", AngleUnit::kRadians);
  EXPECT_FALSE(impossible->wind.direction_deg);
  EXPECT_EQ(impossible->wind.status, DecodedStatus::kUncertain);
}

TEST(Canboat, RefusesWhatHasNoWind) {
  EXPECT_TRUE(refuses(wind_of_fields(R"("Wind Angle":1.0)", AngleUnit::kRadians), Refusal::kInvalid));
  EXPECT_TRUE(refuses(wind_of_fields(R"("Wind Speed":null)", {}), Refusal::kInvalid));
  EXPECT_TRUE(refuses(wind_of_fields(R"("Wind Speed":655.0)", {}), Refusal::kImplausible));
  EXPECT_TRUE(refuses(wind_of_fields(R"("Wind Speed":-1)", {}), Refusal::kImplausible));
  EXPECT_TRUE(refuses(wind_of_fields(R"("Wind Speed":"much")", {}), Refusal::kMalformed));
  EXPECT_TRUE(refuses(wind_of_fields(R"("Wind Speed":[1])", {}), Refusal::kMalformed));
  EXPECT_TRUE(refuses(decode_canboat({}, R"({"src":1,"pgn":128267,"fields":{"Depth":3.42}})"), Refusal::kNotMine));
  EXPECT_TRUE(refuses(decode_canboat({}, R"({"version":"4.12.0","units":"std"})"), Refusal::kNotMine));
  for (const char* line : {"", "[]", "1", "{", R"({"pgn":130306,"src":1})", R"({"pgn":130306,"fields":[1]})",
                           R"({"pgn":130306,"src":900,"fields":{"Wind Speed":1.0}})"}) {
    EXPECT_TRUE(refuses(decode_canboat({}, line), Refusal::kMalformed)) << line;
  }
}

TEST(CanboatPlain, GivesTheWindOfRealAnemometers) {
  struct Known {
    const char* line;
    int address;
    double speed_m_s;
    double direction_deg;
  };
  // 0x0044 and 0xA03B; 0x01DF and 0x0067; both apparent.
  for (const auto& [line, address, speed_m_s, direction_deg] : std::vector<Known>{
           {"2018-02-14T15:55:07.944Z,2,130306,3,255,8,09,44,00,3b,a0,fa,ff,ff", 3, 0.68, 235.02},
           {"2016-02-28T19:57:02.364Z,2,130306,130,255,8,f7,df,01,67,00,fa,ff,ff\r\n", 130, 4.79, 0.59},
           {"2013-05-05-10:11:12.123,2,130306,130,255,8,F7,DF,01,67,00,FA,FF,FF", 130, 4.79, 0.59},
           {"2013-05-05 10:11:12,2,130306,130,255,6,f7,df,01,67,00,fa", 130, 4.79, 0.59},
           {"2013-05-05T10:11:12.123456+02:00,7,130306,130,0,8,f7,df,01,67,00,fa,ff,ff,", 130, 4.79, 0.59}}) {
    EXPECT_TRUE(looks_like_canboat_plain(line)) << line;
    const auto said = decode_canboat_plain(line);
    ASSERT_TRUE(said) << line;
    EXPECT_EQ(said->address, address);
    EXPECT_EQ(said->reference, WindDataReference::kApparent);
    EXPECT_NEAR(said->wind.speed_m_s.value(), speed_m_s, 1e-9) << line;
    EXPECT_NEAR(said->wind.direction_deg.value(), direction_deg, 0.01) << line;
  }
}

TEST(CanboatPlain, PassesOverOtherMessagesOfAnyLength) {
  std::string fast_packet = "2023-06-13T10:39:46.213Z,3,130824,16,255,223";
  for (int i = 0; i < 223; ++i) fast_packet += ",44";
  for (const std::string& line : {std::string("2016-02-28T19:57:02.364Z,2,127250,7,255,8,ff,10,3b,ff,7f,ce,f5,fc"),
                                  std::string("2011-11-24-22:42:04.388,6,126996,36,255,134,09,44,00,3b,a0,fa"),
                                  std::string("2016-02-28T19:57:02.480Z,0,262386,0,0,33,01,0e,00,d7,e2,01"),
                                  fast_packet, fast_packet.substr(0, 60)}) {
    EXPECT_TRUE(refuses(decode_canboat_plain(line), Refusal::kNotMine)) << line;
  }
}

TEST(CanboatPlain, RefusesWhatIsHurt) {
  for (const char* line :
       {"", "2018-02-14T15:5", "2018-02-14T15:55:07.944Z,2,130306,3,255", "2018-02-14T15:55:07.944Z,2,130306,3,255,8",
        "2018-02-14T15:55:07.944Z,2,130306,3,255,8,", "2018-02-14T15:55:07.944Z,2,130306,3,255,8,09,44,00,3b,a0,fa,ff",
        "2018-02-14T15:55:07.944Z,2,130306,3,255,8,09,44,00,3b,a0,fa,ff,"}) {
    EXPECT_TRUE(refuses(decode_canboat_plain(line), Refusal::kTooShort)) << line;
  }
  for (const char* line : {"2018-02-14T15:55:07.944Z,2,130306,3,255,8,09,44,00,3b,a0,fa,ff,ff,ff",
                           "2018-02-14T15:55:07.944Z,2,130306,3,255,9,09,44,00,3b,a0,fa,ff,ff,ff",
                           "2018-02-14T15:55:07.944Z,2,130306,3,255,8,09,44,00,3b,a0,f,ff,ff",
                           "2018-02-14T15:55:07.944Z,2,130306,3,255,8,09,44,00,,a0,fa,ff,ff",
                           "2018-02-14T15:55:07.944Z,2,130306,3,255,8,09,44,0x,3b,a0,fa,ff,ff",
                           "2018-02-14T15:55:07.944Z,8,130306,3,255,8,09,44,00,3b,a0,fa,ff,ff",
                           "2018-02-14T15:55:07.944Z,2,1303060,3,255,8,09,44,00,3b,a0,fa,ff,ff",
                           "2018-02-14T15:55:07.944Z,2,130306,256,255,8,09,44,00,3b,a0,fa,ff,ff",
                           "2018-02-14T15:55:07.944Z,2,130306,-3,255,8,09,44,00,3b,a0,fa,ff,ff",
                           "2018-02-14T15:55:07.944Z,2,0x1FD02,3,255,8,09,44,00,3b,a0,fa,ff,ff",
                           "2018-02-142018-02-14T15:55:07.944Z,2,130306,3,255,8,09,44,00,3b,a0,fa,ff,ff",
                           "15:55:07.944,2,130306,3,255,8,09,44,00,3b,a0,fa,ff,ff",
                           "2018-02-14T15:55:07.,2,130306,3,255,8,09,44,00,3b,a0,fa,ff,ff",
                           "2018-02-14,15:55:07,2,130306,3,255,8,09,44"}) {
    EXPECT_TRUE(refuses(decode_canboat_plain(line), Refusal::kMalformed)) << line;
  }
  EXPECT_TRUE(refuses(decode_canboat_plain("2018-02-14T15:55:07.944Z,2,130306,3,255,3,09,44,00"), Refusal::kTooShort))
      << "as decode_wind_data()";
  EXPECT_TRUE(refuses(decode_canboat_plain("2018-02-14T15:55:07.944Z,2,130306,3,255,8,09,ff,ff,3b,a0,fa,ff,ff"),
                      Refusal::kInvalid));
}

TEST(Actisense, GivesTheWind) {
  for (const char* line : {"A173321.107 82FF2 1FD02 F7DF016700FAFFFF", "A764027.880 82FF2 1fd02 f7df016700fa\r\n",
                           "A173321.107 82FF2 1FD02 F7 DF 01 67 00 FA FF FF"}) {
    EXPECT_TRUE(looks_like_actisense(line)) << line;
    const auto said = decode_actisense(line);
    ASSERT_TRUE(said) << line;
    EXPECT_EQ(said->address, 130);
    EXPECT_EQ(said->reference, WindDataReference::kApparent);
    EXPECT_NEAR(said->wind.speed_m_s.value(), 4.79, 1e-9);
    EXPECT_NEAR(said->wind.direction_deg.value(), 0.59, 0.01);
  }
}

TEST(Actisense, RefusesWhatIsNoWind) {
  for (const char* line : {"A173321.107 23FF7 1F513 012F3070002F30709F",
                           "A764027.880 05FF7 1EF00 E59861060202FFFFFFFF03030000FFFFFFFFFFFFFFFFFFFF0000FFFFFF7FFFF"}) {
    EXPECT_TRUE(refuses(decode_actisense(line), Refusal::kNotMine)) << line;
  }
  for (const char* line : {"", "A173321.107", "A173321.107 82FF2 1FD02", "A173321.107 82FF2 1FD02 F7DF01"}) {
    EXPECT_TRUE(refuses(decode_actisense(line), Refusal::kTooShort)) << line;
  }
  for (const char* line : {"173321.107 82FF2 1FD02 F7DF016700FAFFFF", "A17332.107 82FF2 1FD02 F7DF016700FAFFFF",
                           "A173321.107 2FF2 1FD02 F7DF016700FAFFFF", "A173321.107 82FFA 1FD02 F7DF016700FAFFFF",
                           "A173321.107 82FF2 FD02 F7DF016700FAFFFF", "A173321.107 82FF2 51FD02 F7DF016700FAFFFF",
                           "A173321.107 82FF2 1FD02 F7DF016700FAFFF", "A173321.107 82FF2 1FD02 F7DF016700FAFFFF00",
                           "A173321.107 82FF2 1FD02 F7DF0167x0FAFFFF", "A173321.1073 82FF2 1FD02 F7DF016700FAFFFF"}) {
    EXPECT_TRUE(refuses(decode_actisense(line), Refusal::kMalformed)) << line;
  }
}

constexpr const char* kPlainLine = "2016-02-28T19:57:02.364Z,2,130306,130,255,8,f7,df,01,67,00,fa,ff,ff";
constexpr const char* kActisenseLine = "A173321.107 82FF2 1FD02 F7DF016700FAFFFF";

TEST(BusLine, DetectsTheFormatOfEachLine) {
  EXPECT_EQ(bus_line_format_of(kPlainLine), BusLineFormat::kCanboatPlain);
  EXPECT_EQ(bus_line_format_of(kActisenseLine), BusLineFormat::kActisense);
  EXPECT_EQ(bus_line_format_of("17:33:21.179 R 09FD0205 64 1E"), BusLineFormat::kYachtDevices);
  EXPECT_EQ(bus_line_format_of("can0 09FD0205#641E01C8F1FAFFFF"), BusLineFormat::kCandump);
  EXPECT_EQ(bus_line_format_of(R"({"pgn":130306})"), BusLineFormat::kCanboat);
  EXPECT_EQ(bus_line_format_of("1597516803000;A;" + std::string(kActisenseLine)), BusLineFormat::kActisense);
  for (const char* line : {"", "$WIMWV,230.6,R,3.42,M,A*12", "3.4 315", "12:00:00,3.4,315", "1597516803000;A;"})
    EXPECT_EQ(bus_line_format_of(line), std::nullopt) << line;

  BusLineDecoder lines({});
  for (const std::string& line :
       {std::string(kPlainLine), std::string(kActisenseLine), "1597516803000;A;" + std::string(kPlainLine) + "\r\n",
        "1597516803000;A;" + std::string(kActisenseLine)}) {
    const auto said = lines.decode(line);
    ASSERT_TRUE(said) << line;
    EXPECT_NEAR(said->wind.speed_m_s.value(), 4.79, 1e-9);
  }
  EXPECT_TRUE(refuses(lines.decode("1597516803000;N;$WIMWV,230.6,R,3.42,M,A*12"), Refusal::kNotMine));
  EXPECT_TRUE(refuses(lines.decode("$WIMWV,230.6,R,3.42,M,A*12"), Refusal::kMalformed));
  EXPECT_TRUE(refuses(lines.decode(" "), Refusal::kTooShort));
}

TEST(BusLine, TakesTheOneFormatThatItIsTold) {
  BusLineDecoder yacht({.format = BusLineFormat::kYachtDevices, .angle_unit = {}});
  EXPECT_TRUE(yacht.decode("17:33:21.179 R 09FD0205 64 1E 01 C8 F1 FA FF FF"));
  EXPECT_TRUE(refuses(yacht.decode(kPlainLine), Refusal::kMalformed));
  EXPECT_TRUE(refuses(yacht.decode("17:33"), Refusal::kTooShort));
  BusLineDecoder plain({.format = BusLineFormat::kCanboatPlain, .angle_unit = {}});
  EXPECT_TRUE(plain.decode(kPlainLine));
  EXPECT_TRUE(refuses(plain.decode(kActisenseLine), Refusal::kMalformed));
}

TEST(BusLine, HasATimeAsItIsWritten) {
  using Clock = BusLineClock;
  struct Known {
    std::string line;
    Clock clock;
    std::string text;
  };
  for (const auto& [line, clock, text] : std::vector<Known>{
           {kPlainLine, Clock::kDate, "2016-02-28T19:57:02.364Z"},
           {"2013-05-05-10:11:12.123,6,126996,36,255,134,09", Clock::kDate, "2013-05-05-10:11:12.123"},
           {R"({"timestamp":"2020-06-05-18:03:25.626","prio":2,"pgn":130306})", Clock::kDate,
            "2020-06-05-18:03:25.626"},
           {kActisenseLine, Clock::kMidnight, "173321.107"},
           {"17:33:21.179 R 09FD0205 64", Clock::kMidnight, "17:33:21.179"},
           {"(1436509052.249713) can0 09FD0205#64", Clock::kUnixSeconds, "1436509052.249713"},
           {"1597516803000;A;2020-08-15T18:40:03.000Z,2,130306,130,255,8,f7", Clock::kDate, "2020-08-15T18:40:03.000Z"},
           {"1597516803000;A;can0 09FD0205#64", Clock::kUnixMilliseconds, "1597516803000"}}) {
    const auto time = bus_line_time(line);
    ASSERT_TRUE(time) << line;
    EXPECT_EQ(time->clock, clock) << line;
    EXPECT_EQ(time->text, text);
  }
  for (const char* line : {"", "can0 09FD0205#64", "2018-02-14", "2018-02-14T15:55,2", R"({"version":"4.12.0"})",
                           R"({"timestamp":)", "$WIMWV,230.6,R,3.42,M,A*12"}) {
    EXPECT_FALSE(bus_line_time(line)) << line;
  }
}

TEST(SignalK, KnowsTheServersHello) {
  const auto hello = signalk_hello(
      R"({"name":"foobar marine server","version":"1.0.4","timestamp":"2018-06-21T15:09:16.704Z","self":"vessels.urn:mrn:signalk:uuid:c0d79334-4e25-4245-8892-54e8ccc8021d","roles":["master","main"]})");
  ASSERT_TRUE(hello);
  EXPECT_EQ(hello->timestamp, "2018-06-21T15:09:16.704Z");
  EXPECT_EQ(hello->self, "vessels.urn:mrn:signalk:uuid:c0d79334-4e25-4245-8892-54e8ccc8021d");
  EXPECT_FALSE(signalk_hello(delta(value("speedTrue", "1"))));
  EXPECT_FALSE(signalk_hello(R"({"version":"4.12.0","units":"std"})"));
}

TEST(SignalK, GivesTheValuesOfADelta) {
  const auto said = decode_signalk(delta(value("speedApparent", "4.01") + "," + value("angleApparent", "-0.5"),
                                         R"("$source":"n2k.105","timestamp":"2026-06-21T15:09:17.012Z")"));
  ASSERT_TRUE(said);
  EXPECT_EQ(said->context, "vessels.self");
  ASSERT_EQ(said->updates.size(), 1U);
  EXPECT_EQ(said->updates[0].source, "n2k.105");
  EXPECT_EQ(said->updates[0].timestamp, "2026-06-21T15:09:17.012Z");
  const auto winds = signalk_winds(said->updates[0].values);
  ASSERT_TRUE(winds[2]);
  EXPECT_EQ(winds[2]->wind.speed_m_s, 4.01);
  EXPECT_NEAR(winds[2]->wind.direction_deg.value(), 360.0 - 0.5 / kRadPerDeg, 1e-9) << "to port";
  EXPECT_EQ(winds[2]->wind.reference, WindReference::kRelative);
  for (const std::size_t other : {0U, 1U, 3U, 4U}) EXPECT_FALSE(winds[other]);
}

TEST(SignalK, NamesASourceByWhatIsSaidOfIt) {
  const auto source = [](const std::string& head) {
    return decode_signalk(delta(value("speedTrue", "1"), head))->updates[0].source;
  };
  EXPECT_EQ(source(R"("source":{"label":"n2k","type":"NMEA2000","pgn":130306,"src":"105"})"), "n2k.105");
  EXPECT_EQ(source(R"("source":{"label":"mast"})"), "mast");
  EXPECT_EQ(source(R"("timestamp":"now")"), "");
  EXPECT_EQ(source(R"("$source":"a\u0007b\u00e9")"), "a.b..");
}

TEST(SignalK, PutsEachDirectionBesideItsSpeed) {
  const auto winds = [](const std::string& values) {
    return signalk_winds(decode_signalk(delta(values))->updates[0].values);
  };
  const auto north =
      winds(value("directionTrue", "1.0") + "," + value("speedTrue", "2") + "," + value("speedOverGround", "3"));
  ASSERT_TRUE(north[0]);
  EXPECT_EQ(north[0]->wind.speed_m_s, 3.0);
  EXPECT_EQ(north[0]->wind.reference, WindReference::kNorth);
  EXPECT_FALSE(north[1]);
  const auto magnetic = winds(value("directionMagnetic", "1.0") + "," + value("speedTrue", "2"));
  EXPECT_EQ(magnetic[1]->wind.speed_m_s, 2.0);
  EXPECT_EQ(magnetic[1]->wind.reference, WindReference::kMagnetic);
  const auto from_bow = winds(value("angleTrueGround", "1.0") + "," + value("speedOverGround", "3") + "," +
                              value("angleTrueWater", "2.0") + "," + value("speedTrue", "2"));
  EXPECT_FALSE(from_bow[0]);
  EXPECT_EQ(from_bow[3]->wind.speed_m_s, 3.0);
  EXPECT_NEAR(from_bow[3]->wind.direction_deg.value(), 1.0 / kRadPerDeg, 1e-9);
  EXPECT_EQ(from_bow[4]->wind.speed_m_s, 2.0);
  EXPECT_NEAR(from_bow[4]->wind.direction_deg.value(), 2.0 / kRadPerDeg, 1e-9);
}

TEST(SignalK, RefusesWhatIsNoWind) {
  EXPECT_TRUE(refuses(decode_signalk(R"({"updates":[{"values":[{"path":"navigation.headingTrue","value":1.0}]}]})"),
                      Refusal::kNotMine));
  EXPECT_TRUE(refuses(decode_signalk(R"({"updates":[{"meta":[{"path":"environment.wind.speedTrue","value":{}}]}]})"),
                      Refusal::kNotMine));
  EXPECT_TRUE(refuses(decode_signalk(R"({"requestId":"1","state":"COMPLETED"})"), Refusal::kNotMine));
  EXPECT_TRUE(refuses(decode_signalk(delta(value("speedTrue", "null"))), Refusal::kInvalid));
  EXPECT_TRUE(refuses(decode_signalk(delta(value("speedTrue", "-1e9"))), Refusal::kImplausible));
  EXPECT_TRUE(refuses(decode_signalk(delta(value("angleApparent", "-1e9"))), Refusal::kInvalid)) << "a mark for none";
  for (const std::string& line :
       {std::string(), std::string("[]"), std::string(R"({"updates":{}})"), std::string(R"({"updates":[1]})"),
        std::string(R"({"updates":[{"values":1}]})"), delta("1"), delta(R"({"value":1})"),
        delta(value("speedTrue", "\"1\"")), delta(value("speedTrue", "1")).substr(0, 60)}) {
    EXPECT_TRUE(refuses(decode_signalk(line), Refusal::kMalformed)) << line;
  }
}

}  // namespace
}  // namespace yuragi::drivers::decode::marine
