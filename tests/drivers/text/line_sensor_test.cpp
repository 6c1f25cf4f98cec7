#include "drivers/text/line_sensor.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/scripted_text.hpp"

namespace yuragi::drivers::text {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;

class LineSensorTest : public testing::Test, protected ScriptedText {
 protected:
  /// Hears a line after one that it may doubt.
  void receive_line(const std::string& line) {
    receive("#\n");
    receive(line + "\n");
  }
};

TEST_F(LineSensorTest, ReadsColumnsAndKeys) {
  make_line({{"gust_column", std::int64_t{3}}});
  receive_line("4.2,270,6.1");
  ASSERT_EQ(sink.readings.size(), 1U);
  EXPECT_DOUBLE_EQ(sink.readings[0].speed_m_s, 4.2);
  EXPECT_EQ(sink.readings[0].direction_deg, 270.0);
  EXPECT_EQ(sink.readings[0].gust_m_s, 6.1);
  make_line();
  receive_line("speed=4.2 direction=270");
  ASSERT_EQ(sink.readings.size(), 2U);
  EXPECT_DOUBLE_EQ(sink.readings[1].speed_m_s, 4.2);
}

TEST_F(LineSensorTest, ReadsWhatItsParametersSay) {
  make_line({{"separator", std::string("semicolon")},
             {"speed_column", std::int64_t{3}},
             {"direction_column", std::int64_t{1}},
             {"speed_unit", std::string("km/h")},
             {"speed_scale", 0.1},
             {"speed_offset", 1.8},
             {"direction_scale", 22.5},
             {"north_offset", -90.0},
             {"invalid", std::string("-999")}});
  receive_line("2;21.5;180");
  ASSERT_EQ(sink.readings.size(), 1U);
  EXPECT_NEAR(sink.readings[0].speed_m_s, 19.8 / 3.6, 1e-9);
  EXPECT_NEAR(*sink.readings[0].direction_deg, 315.0, 1e-9);
  receive("-999;21.5;180\n");
  ASSERT_EQ(sink.readings.size(), 2U);
  EXPECT_FALSE(sink.readings[1].direction_deg.has_value());
  receive("2;21.5;-999\n");
  EXPECT_EQ(sink.readings.size(), 2U);
  EXPECT_EQ(sink.count(decode::Refusal::kInvalid), 1);
}

TEST_F(LineSensorTest, KnowsEachUnit) {
  for (const auto& [unit, speed_m_s] :
       {std::pair("m/s", 10.0), std::pair("km/h", 2.7778), std::pair("kn", 5.1444), std::pair("mph", 4.4704)}) {
    make_line({{"speed_unit", std::string(unit)}});
    receive_line("10,90");
    EXPECT_NEAR(sink.readings.back().speed_m_s, speed_m_s, 1e-4) << unit;
  }
}

TEST_F(LineSensorTest, DoubtsTheLineInWhoseMiddleItBegan) {
  make_line();
  far_end.send("2.5,180\r\n");  // of "12.5,180"
  receive("12.5,180\r\n");
  ASSERT_EQ(sink.readings.size(), 1U);
  EXPECT_EQ(sink.readings[0].speed_m_s, 12.5);

  // A datagram is whole.
  make_line({{"transport", std::string("udp")}});
  far_end.incoming.push_back({bus::ByteStatus::kBytes, "12.5,180", true});
  run(1s);
  EXPECT_EQ(sink.readings.size(), 2U);
}

TEST_F(LineSensorTest, TakesOfAFloodOfDatagramsNoMoreThanTheLimit) {
  make_line({{"transport", std::string("udp")}});
  for (int i = 0; i < 1000; ++i) far_end.incoming.push_back({bus::ByteStatus::kBytes, "12.5,180", true});
  const MonoTime begin = clock.now().mono;
  while (!far_end.incoming.empty()) clock.advance_to(sensor->poll(clock, sink));
  const auto most = static_cast<std::size_t>(100.0 * seconds(clock.now().mono - begin) + 100.0);
  EXPECT_GT(sink.readings.size(), 0U);
  EXPECT_LE(sink.readings.size(), most);
  EXPECT_EQ(std::ssize(sink.readings) + sink.count(decode::Refusal::kTooFrequent), 1000);
}

TEST_F(LineSensorTest, RefusesALineOfAnotherShapeUntilItComesAgain) {
  make_line();
  receive_line("4.2,270");
  receive("4.2,274.3,270\n");  // two, run into each other
  receive("4\n");
  EXPECT_EQ(sink.readings.size(), 1U);
  EXPECT_EQ(sink.count(decode::Refusal::kMalformed), 2);
  receive("4.2,270\n");
  EXPECT_EQ(sink.readings.size(), 2U);

  // The sketch was changed.
  receive("4.2,270,21.5\n");
  receive("4.2,270,21.5\n");
  EXPECT_EQ(sink.readings.size(), 3U);
}

TEST_F(LineSensorTest, RefusesALineNextToGarbage) {
  make_line();
  receive_line("4.2,270");
  receive("\xf3\x91\n7,7\n");
  EXPECT_EQ(sink.readings.size(), 1U);
  receive("4.2,270\n");
  EXPECT_EQ(sink.readings.size(), 2U);
}

TEST_F(LineSensorTest, DropsALineThatPausesInTheMiddle) {
  make_line();
  receive_line("4.2,270");
  receive("4.2,2");
  run(1s);
  receive("4.3,271\n");
  ASSERT_EQ(sink.readings.size(), 2U);
  EXPECT_EQ(sink.readings[1].speed_m_s, 4.3);
  EXPECT_EQ(sink.readings[1].direction_deg, 271.0);
  EXPECT_EQ(sink.count(decode::Refusal::kTooShort), 1);
}

TEST_F(LineSensorTest, JoinsOneValueALine) {
  const ParameterValues::Map keys = {{"speed_key", std::string("WindSpeed")},
                                     {"direction_key", std::string("WindDir")},
                                     {"gust_key", std::string("WindGust")},
                                     {"hold", 5.0}};
  for (const std::string sign : {"=", "    = ", ": "}) {
    sink.readings.clear();
    make_line(keys);
    receive("#\n");
    for (const char* speed : {"0.5", "0.7"}) {
      receive("WindDir" + sign + "79\nWindSpeed" + sign + speed + "\nWindGust" + sign + "1.5\nRain" + sign + "0.0\n");
      run(1s);
    }
    ASSERT_EQ(sink.readings.size(), 2U) << sign;
    EXPECT_EQ(sink.readings[0].speed_m_s, 0.5);
    EXPECT_EQ(sink.readings[0].direction_deg, 79.0);
    EXPECT_FALSE(sink.readings[0].gust_m_s) << "it comes behind the speed";
    EXPECT_EQ(sink.readings[1].speed_m_s, 0.7);
    EXPECT_EQ(sink.readings[1].direction_deg, 79.0);
    EXPECT_EQ(sink.readings[1].gust_m_s, 1.5);

    receive("WindDir" + sign + "nan\nWindSpeed" + sign + "0.8\n");
    ASSERT_EQ(sink.readings.size(), 3U);
    EXPECT_FALSE(sink.readings[2].direction_deg) << "the device has none any more";
    EXPECT_EQ(sink.readings[2].gust_m_s, 1.5);
    receive("WindDir" + sign + "90\n");
    run(6s);
    receive("WindSpeed" + sign + "0.9\n");
    ASSERT_EQ(sink.readings.size(), 4U);
    EXPECT_FALSE(sink.readings[3].direction_deg) << "it is older than `hold`";
  }
}

TEST_F(LineSensorTest, TakesLinesOfSeveralShapesThatComeInTurn) {
  make_line();
  receive("#\n");
  for (int block = 0; block < 4; ++block) receive("direction=90\nspeed=4 gust=6\n");
  EXPECT_GE(sink.readings.size(), 3U);
  EXPECT_EQ(sink.readings.back().direction_deg, 90.0);
  EXPECT_LE(sink.count(decode::Refusal::kMalformed), 1);
}

TEST_F(LineSensorTest, KeepsTheSpeedBesideADirectionThatCannotBeRead) {
  make_line({{"north_offset", 90.0}});
  receive_line("4.2,NW");
  receive("4.3,up\n");
  ASSERT_EQ(sink.readings.size(), 2U);
  EXPECT_EQ(sink.readings[0].direction_deg, 45.0);
  EXPECT_EQ(sink.readings[1].speed_m_s, 4.3);
  EXPECT_FALSE(sink.readings[1].direction_deg);
  EXPECT_EQ(sink.readings[1].quality, wind::ReadingQuality::kUncertain);
}

TEST_F(LineSensorTest, ReportsWhatIsWrongWithTheSettingsAndNotWithTheDevice) {
  const auto trouble_with = [this](const std::string& line, const ParameterValues::Map& given) {
    far_end.incoming.clear();
    make_line(given);
    for (int i = 0; i < 20; ++i) {
      receive(line + "\n");
      run(250ms);
    }
    return sink.last_detail();
  };
  for (const char* line : {"WindSpeed = 1.0", "WindSpeed 1.0", "ready", "{\"ws\": 1}", "W;1;2;3"}) {
    EXPECT_THAT(trouble_with(line, {}), HasSubstr("but without wind")) << line;
    EXPECT_THAT(trouble_with(line, {{"speed_column", std::int64_t{6}}, {"direction_column", std::int64_t{7}}}),
                HasSubstr("check that the settings match"))
        << line;
  }
  for (const auto& [line, driver] : std::vector<std::pair<std::string, std::string>>{
           {"2018-02-14T15:55:07.944Z,2,130306,3,255,8,09,44,00,3b,a0,fa,ff,ff", "nmea2000"},
           {"16:29:27.082 R 09F10D0A FF 00 00 00 FF 7F FF FF", "nmea2000"},
           {"$WIMWV,214.8,R,4.2,M,A", "nmea"},
           {"0R1,Dm=066D,Sm=9.5M", "nmea"},
           {R"({"updates":[{"values":[{"path":"environment.wind.speedApparent","value":4.0}]}]})", "signalk"}}) {
    EXPECT_THAT(trouble_with(line, {{"speed_column", std::int64_t{20}}, {"direction_column", std::int64_t{21}}}),
                HasSubstr("that the driver " + driver + " reads"))
        << line;
  }
  const std::string trouble = trouble_with("WindDir=79", {{"direction_key", std::string("WindDir")}});
  EXPECT_THAT(trouble, HasSubstr("none with a speed (\"WindDir=79\" has none): check speed_key"));
  EXPECT_EQ(sink.last_state(), wind::LinkState::kConnecting);
  EXPECT_THAT(trouble_with("nan,270", {}), HasSubstr("without a value for the speed (the first: \"nan,270\")"));
}

TEST_F(LineSensorTest, ForgetsWhatAnArduinoSaysAsItStarts) {
  far_end.send("9.9,9\n9.9,9\n");
  make_line({{"delay_after_open", 2.0}});
  run(3s);
  EXPECT_TRUE(sink.readings.empty());
  EXPECT_TRUE(sink.raws.empty());
  receive_line("4.2,270");
  EXPECT_EQ(sink.readings.size(), 1U);
}

TEST(Text, HasTheDegreeSignButNoOtherByteBeyondAscii) {
  EXPECT_TRUE(is_text("speed=4 direction=270\xC2\xB0"));
  EXPECT_TRUE(is_text("speed=4 direction=270\xB0"));
  EXPECT_FALSE(is_text("speed=4\xC2"));
  EXPECT_FALSE(is_text("speed=4\xFF"));
  EXPECT_FALSE(is_text("\x01"));
}

TEST(LineSettings, RefuseWhatCannotWork) {
  const auto refusal = [](ParameterValues::Map given) -> std::string {
    given.try_emplace("device", std::string("/dev/script"));
    try {
      line_sensor_settings_of(values_for("line", given));
    } catch (const std::runtime_error& error) {
      return error.what();
    }
    return "accepted";
  };
  EXPECT_EQ(refusal({}), "accepted");
  EXPECT_THAT(refusal({{"speed_column", std::int64_t{0}}, {"speed_key", std::string("")}}),
              HasSubstr("set one of them"));
  EXPECT_THAT(refusal({{"direction_column", std::int64_t{1}}}), HasSubstr("has the same column"));
  EXPECT_THAT(refusal({{"invalid", std::string("none")}}), HasSubstr("is not a number"));
  EXPECT_THAT(refusal({{"speed_key", std::string("/wind~/speed")}}),
              HasSubstr("speed_key: \"/wind~/speed\" is not a JSON pointer"));
  EXPECT_THAT(refusal({{"gust_key", std::string("/~2")}, {"format", std::string("json")}}), HasSubstr("gust_key: "));
  EXPECT_EQ(refusal({{"direction_key", std::string("/wind/0/d~1s")}}), "accepted");
  EXPECT_EQ(refusal({{"speed_key", std::string("/~2")}, {"format", std::string("keys")}}), "accepted");
  EXPECT_THAT(refusal({{"poll_interval", 1.0}}), HasSubstr("request: is missing"));
}

}  // namespace
}  // namespace yuragi::drivers::text
