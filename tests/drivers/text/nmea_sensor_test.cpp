#include "drivers/text/nmea_sensor.hpp"

#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/decoded_text.hpp"
#include "tests/support/scripted_text.hpp"

namespace yuragi::drivers::text {
namespace {

using namespace std::chrono_literals;
using testing::ElementsAre;
using testing::HasSubstr;

std::string nmea_line(std::string_view body) {
  return sentence(body) + "\r\n";
}
std::string framed(std::string_view body) {
  const std::string with_checksum = sentence(body);
  return '\x02' + std::string(body) + '\x03' + with_checksum.substr(with_checksum.size() - 2) + "\r\n";
}

class NmeaSensorTest : public testing::Test, protected ScriptedText {
 protected:
  void expect_last(double speed_m_s, std::optional<double> direction_deg) {
    ASSERT_FALSE(sink.readings.empty()) << sink.last_detail();
    EXPECT_NEAR(sink.readings.back().speed_m_s, speed_m_s, 0.006);
    ASSERT_EQ(sink.readings.back().direction_deg.has_value(), direction_deg.has_value());
    if (direction_deg) {
      EXPECT_NEAR(*sink.readings.back().direction_deg, *direction_deg, 0.006);
    }
  }
};

TEST_F(NmeaSensorTest, ReadsEachFormatByItsLook) {
  const std::vector<std::string> lines = {
      nmea_line("WIMWV,123.0,R,7.00,M,A"),
      nmea_line("WIMWD,123.0,T,,M,13.61,N,7.00,M"),
      nmea_line("IIVWR,123.0,R,13.61,N,7.00,M,25.20,K"),
      nmea_line("IIVWT,123.0,R,13.61,N,7.00,M,25.20,K"),
      nmea_line("WIMDA,29.9,I,1.013,B,12.5,C,,,55.0,,3.7,C,123.0,T,,M,13.61,N,7.00,M"),
      nmea_line("WIXDR,A,118,D,0,A,123,D,1,A,128,D,2,S,6.1,M,0,S,7.0,M,1,S,8.2,M,2"),
      framed("Q,123,007.00,M,00,"),
      framed("Q,+003.8125,+005.8707,M,00,"),
      nmea_line("WI,WVP=007.0,123,0"),
  };
  for (const std::string& line : lines) {
    SCOPED_TRACE(line);
    sink = {};
    make_nmea();
    receive(line);
    EXPECT_EQ(sink.readings.size(), 1U);
    expect_last(7.0, 123.0);
    EXPECT_TRUE(sink.refusals.empty());
    EXPECT_EQ(sink.last_state(), wind::LinkState::kConnected);
  }
}

TEST_F(NmeaSensorTest, HandsOnWhatAStationSaysBesidesTheWind) {
  make_nmea({{"talker", std::string("WI")}});
  receive(nmea_line("WIMDA,29.9,I,1.013,B,12.5,C,,,55.0,,3.7,C,123.0,T,,M,13.61,N,7.00,M"));
  receive(nmea_line("WIXDR,C,12.7,C,0"));
  receive(nmea_line("IIXDR,C,40.0,C,0"));
  receive("$WIXDR,C,99.0,C,0*00\r\n");
  ASSERT_EQ(sink.station_quantities.size(), 2U);
  EXPECT_EQ(sink.station_quantities[0].air_temperature_c, 12.5);
  EXPECT_EQ(sink.station_quantities[0].relative_humidity_percent, 55.0);
  EXPECT_EQ(sink.station_quantities[1].air_temperature_c, 12.7);
  EXPECT_EQ(sink.station_quantities[0].time.mono, sink.readings.front().time.mono);
  EXPECT_EQ(sink.readings.size(), 1U);
}

TEST_F(NmeaSensorTest, HandsOnTheVerticalWindOfAWindMaster) {
  make_nmea();
  receive(framed("Q,335.3,001.261,-001.282,M,+345.41,+023.05,00,"));
  receive(framed("Q,335.3,001.261,-001.282,M,+345.41,+023.05,01,"));
  ASSERT_EQ(sink.station_quantities.size(), 1U);
  EXPECT_EQ(sink.station_quantities[0].vertical_speed_m_s, -1.282);
  EXPECT_EQ(sink.readings.size(), 1U);
  expect_last(1.261, 335.3);
}

TEST_F(NmeaSensorTest, PublishesOneWindOfABurstOnceAndPrefersNorth) {
  make_nmea();
  for (int second = 0; second < 10; ++second) {
    far_end.send(nmea_line("WIMWV,57.5,R,13.0,N,A"));
    far_end.send(nmea_line("WIMWV,96.6,T,11.2,N,A"));
    receive(nmea_line("WIMWD,328.2,T,326.8,M,11.2,N,5.8,M"));
    run(750ms);
  }
  EXPECT_EQ(sink.readings.size(), 10U);
  for (const wind::Reading& reading : sink.readings) {
    EXPECT_NEAR(reading.speed_m_s, 5.8, 1e-9);
    EXPECT_EQ(reading.direction_deg, 328.2);
  }
  EXPECT_TRUE(sink.refusals.empty());
  EXPECT_THAT(sink.last_detail(), HasSubstr("MWD of WI"));
}

TEST_F(NmeaSensorTest, TakesTheReferenceThatItIsTold) {
  for (const auto& [reference, speed_m_s] : {std::pair("relative", 6.6878), std::pair("true", 5.7618)}) {
    sink = {};
    make_nmea({{"reference", std::string(reference)}});
    for (int second = 0; second < 3; ++second) {
      far_end.send(nmea_line("WIMWD,328.2,T,326.8,M,11.2,N,5.8,M"));
      far_end.send(nmea_line("WIMWV,57.5,R,13.0,N,A"));
      receive(nmea_line("WIMWV,96.6,T,11.2,N,A"));
    }
    EXPECT_EQ(sink.readings.size(), 3U);
    expect_last(speed_m_s, std::string(reference) == "relative" ? 57.5 : 96.6);
    EXPECT_EQ(sink.count(decode::Refusal::kNotMine), 6);
  }
}

TEST_F(NmeaSensorTest, NeverMixesFramesOfDirection) {
  make_nmea();
  for (int second = 0; second < 3; ++second) {
    far_end.send(nmea_line("WIMWD,328.2,T,,M,11.2,N,5.8,M"));
    receive(nmea_line("WIMWV,57.5,R,13.0,N,A"));
    run(750ms);
  }
  sink.readings.clear();

  // The compass fails: the wind goes on, but its direction from the bow is none from north.
  for (int second = 0; second < 10; ++second) {
    receive(nmea_line("WIMWV,57.5,R,13.0,N,A"));
    run(750ms);
  }
  EXPECT_GE(sink.readings.size(), 5U);
  for (const wind::Reading& reading : sink.readings) EXPECT_FALSE(reading.direction_deg.has_value());

  receive(nmea_line("WIMWD,328.2,T,,M,11.2,N,5.8,M"));
  run(750ms);
  receive(nmea_line("WIMWD,328.2,T,,M,11.2,N,5.8,M"));
  expect_last(5.8, 328.2);
}

/// A station without a compass: its MWD never has a direction.
TEST_F(NmeaSensorTest, TakesTheDirectionOfAnotherSentenceWhereItsOwnHasNone) {
  for (const bool is_mwd_first : {false, true}) {
    SCOPED_TRACE(is_mwd_first);
    sink = {};
    make_nmea();
    for (int second = 0; second < 10; ++second) {
      if (is_mwd_first) far_end.send(nmea_line("WIMWD,,T,,M,13.0,N,6.7,M"));
      far_end.send(nmea_line("WIMWV,57.5,R,13.0,N,A"));
      if (!is_mwd_first) far_end.send(nmea_line("WIMWD,,T,,M,13.0,N,6.7,M"));
      run(1s);
    }
    EXPECT_EQ(sink.readings.size(), 10U) << "each measurement once";
    for (const wind::Reading& reading : sink.readings) {
      EXPECT_EQ(reading.speed_m_s, 6.7);
      EXPECT_EQ(reading.direction_deg, 57.5);
    }
    EXPECT_THAT(sink.last_detail(), HasSubstr("MWD of WI with the direction of MWV of WI"));
    EXPECT_LE(sink.links.size(), 2U) << "told once";
  }
}

/// Once heard, never again: the direction that is left is better than none.
TEST_F(NmeaSensorTest, FallsBackToTheDirectionThatIsLeftAndReturns) {
  make_nmea({{"north_offset", 10.0}});
  far_end.send(nmea_line("WIMWD,328.2,T,,M,13.0,N,6.7,M"));
  receive(nmea_line("WIMWV,57.5,R,13.0,N,A"));
  run(750ms);
  expect_last(6.7, 328.2);
  sink = {};
  for (int second = 0; second < 90; ++second) {
    receive(nmea_line("WIMWV,57.5,R,13.0,N,A"));
    run(750ms);
    if (second == 20) {
      expect_last(6.6878, {});
      EXPECT_THAT(sink.last_detail(), HasSubstr("MWV of WI without a direction, because MWD of WI has none"));
    }
  }
  expect_last(6.6878, 67.5);
  EXPECT_THAT(sink.last_detail(), testing::StartsWith("MWV of WI at "));
  const auto told = std::ranges::count_if(
      sink.links, [](const auto& link) { return link.detail.find("without a direction") != std::string::npos; });
  EXPECT_EQ(told, 1);

  for (int second = 0; second < 3; ++second) {
    receive(nmea_line("WIMWD,328.2,T,,M,13.0,N,6.7,M"));
    run(750ms);
  }
  expect_last(6.7, 328.2);
}

TEST_F(NmeaSensorTest, ASentenceWithADirectionAloneLeavesTheSpeedToAnother) {
  make_nmea();
  for (int second = 0; second < 10; ++second) {
    far_end.send(nmea_line("WIMWD,328.2,T,,M,,N,,M"));
    receive(nmea_line("WIMWV,57.5,R,13.0,N,A"));
    run(750ms);
  }
  EXPECT_EQ(sink.readings.size(), 10U);
  for (const wind::Reading& reading : sink.readings) {
    EXPECT_NEAR(reading.speed_m_s, 6.6878, 1e-3);
    EXPECT_EQ(reading.direction_deg, 328.2);
  }
}

TEST_F(NmeaSensorTest, ACalmWithoutADirectionIsNoSilenceOfIt) {
  make_nmea();
  for (int second = 0; second < 200; ++second) {
    far_end.send(nmea_line(second < 10 || second > 190 ? "WIMWD,328.2,T,,M,13.0,N,6.7,M" : "WIMWD,,T,,M,0.0,N,0.0,M"));
    receive(nmea_line("WIMWV,57.5,R,0.1,N,A"));
    run(750ms);
  }
  for (const wind::Reading& reading : sink.readings) EXPECT_EQ(reading.direction_deg.value_or(328.2), 328.2);
  EXPECT_EQ(sink.links.size(), 1U);
}

TEST_F(NmeaSensorTest, HasNoDirectionInACalmAndNeverAZero) {
  make_nmea();
  receive(nmea_line("WIMWD,328.2,T,,M,11.2,N,5.8,M"));
  receive(nmea_line("WIMWD,,T,,M,0.0,N,0.0,M"));
  expect_last(0.0, {});
  make_nmea();
  receive(framed("Q,229,002.74,M,00,"));
  receive(framed("Q,,000.04,M,00,"));
  expect_last(0.04, {});
}

TEST_F(NmeaSensorTest, TakesTheTalkersAndSentencesThatItIsTold) {
  make_nmea({{"talker", std::string("24")}});
  receive(nmea_line("02MWV,327.6,R,1.89,N"));
  EXPECT_TRUE(sink.readings.empty());
  receive(nmea_line("24MWV,88.8,R,0.36,N"));
  expect_last(0.1852, 88.8);
  EXPECT_EQ(sink.readings.back().quality, wind::ReadingQuality::kUncertain) << "it says nothing of its status";

  sink = {};
  make_nmea({{"sentences", std::string("VWR, MWV")}});
  receive(nmea_line("WIMWD,328.2,T,,M,11.2,N,5.8,M"));
  EXPECT_THAT(sink.refusals, ElementsAre(decode::Refusal::kNotMine));
  receive(nmea_line("WIMWV,57.5,R,13.0,N,A"));
  expect_last(6.6878, 57.5);

  sink = {};
  make_nmea({{"talker", std::string("Q")}});
  receive(framed("R,229,002.74,M,00,"));
  EXPECT_TRUE(sink.readings.empty());
  receive(framed("Q,229,002.74,M,00,"));
  expect_last(2.74, 229.0);
}

TEST_F(NmeaSensorTest, TurnsDirectionsByTheMarkAndTheVariation) {
  make_nmea({{"north_offset", -20.0}, {"variation", 7.5}});
  receive(nmea_line("WIMWV,10.0,R,5.0,M,A"));
  expect_last(5.0, 350.0);
  make_nmea({{"north_offset", -20.0}, {"variation", 7.5}});
  receive(nmea_line("IIMWD,,,355.0,M,10.1,N,5.0,M"));
  expect_last(5.0, 2.5);
  make_nmea({{"north_offset", -20.0}, {"variation", 7.5}});
  receive(nmea_line("IIMWD,10.0,T,355.0,M,10.1,N,5.0,M"));
  expect_last(5.0, 10.0);
}

TEST_F(NmeaSensorTest, ReportsAnotherFormatAndNotTheCable) {
  // Keys of a sketch that begin with a dollar sign, Gill's shape without its checksum, and a sentence of no wind.
  for (const char* line : {"$,winddir=45,windspeedmph=2.0,#", "A,270,003.20,M", "WindSpeed = 1.0", "$GPRSA,,V,,V"}) {
    make_nmea();
    for (int i = 0; i < 20; ++i) {
      receive(std::string(line) + "\r\n");
      run(250ms);
    }
    EXPECT_THAT(sink.last_detail(), HasSubstr("check that the settings match")) << line;
    EXPECT_THAT(sink.last_detail(), testing::Not(HasSubstr("cable"))) << line;
  }
}

TEST_F(NmeaSensorTest, TakesLinesWithoutAChecksumWhereTheWireHasOneOfItsOwn) {
  make_nmea();
  for (int i = 0; i < 20; ++i) receive("$WIMWV,214.8,R,0.1,K\r\n");
  EXPECT_TRUE(sink.readings.empty());
  EXPECT_EQ(sink.count(decode::Refusal::kBadChecksum), 20);
  EXPECT_THAT(sink.last_detail(), HasSubstr("missing_checksum to \"accept\""));

  for (const ParameterValues::Map& given : {ParameterValues::Map{{"missing_checksum", std::string("accept")}},
                                            ParameterValues::Map{{"transport", std::string("udp")}}}) {
    sink = {};
    make_nmea(given);
    receive("$WIMWV,214.8,R,0.1,K\r\n");
    expect_last(0.1 / 3.6, 214.8);
    EXPECT_EQ(sink.readings.back().quality, wind::ReadingQuality::kUncertain);
    receive("$WIMWV,214.8,R,0.1,K*00\r\n");
    EXPECT_EQ(sink.count(decode::Refusal::kBadChecksum), 1) << "a wrong one is wrong everywhere";
  }

  sink = {};
  make_nmea({{"missing_status", std::string("refuse")}});
  receive(nmea_line("02MWV,327.6,R,1.89,N"));
  EXPECT_TRUE(sink.readings.empty());
}

TEST_F(NmeaSensorTest, ReadsOnWhereOthersTalkOnTheSameLine) {
  make_nmea();
  for (int second = 0; second < 20; ++second) {
    far_end.send("!AIVDM,1,1,,A,13u?etPv2;0n:dDPwUM1U1Cb069D,0*24\r\n");
    far_end.send("Calypso ready\r\n");
    far_end.send(nmea_line("GPGGA,094736,5251.0094,N,00518.8172,E,1,12,0.60,-4,M,46.8,M,,"));
    far_end.send(std::string(3, '\0') + nmea_line("WIMWV,046.,R,5.0,M,A"));
    run(1s);
  }
  EXPECT_GE(sink.readings.size(), 19U);
  EXPECT_EQ(sink.count(decode::Refusal::kNotMine), 60);
  EXPECT_EQ(std::ssize(sink.refusals), 60);
  EXPECT_EQ(sink.last_state(), wind::LinkState::kConnected);
}

TEST_F(NmeaSensorTest, JoinsADirectionAndASpeedThatComeApart) {
  make_nmea({{"format", std::string("umb")}, {"transport", std::string("udp")}});
  receive("$ 28673 M 00500 32760\r\n");
  EXPECT_TRUE(sink.readings.empty()) << "a direction alone is no reading";
  receive("$ 28673 M 00400 08736\r\n");
  expect_last(10.0, 179.95);
  receive("$ 28673 M 00500 32760\r\n");
  run(3s);
  receive("$ 28673 M 00400 08736\r\n");
  expect_last(10.0, {});
}

TEST_F(NmeaSensorTest, AsksADeviceThatOnlyAnswers) {
  make_nmea({{"format", std::string("umb")}});
  far_end.on_request = [this](const std::string& request) {
    far_end.send(request + "\n");  // one pair of wires: everybody hears himself
    far_end.send(nmea_line("WIMWV,230.6,R,003.4,N,A"));
  };
  run(10s);
  ASSERT_GE(far_end.written.size(), 9U);
  EXPECT_LE(far_end.written.size(), 11U);
  EXPECT_EQ(far_end.written.front(), "01TR4\r");
  EXPECT_GE(sink.readings.size(), 9U);
  expect_last(1.749, 230.6);
  EXPECT_EQ(std::ranges::count(sink.raws, sensor::RawDirection::kSent, &RecordingSink::Raw::direction),
            std::ssize(far_end.written));

  far_end = {};
  make_nmea({{"format", std::string("ft")}, {"poll_interval", 0.5}, {"address", std::string("02")}});
  run(1s);
  ASSERT_FALSE(far_end.written.empty());
  EXPECT_EQ(far_end.written.front(), sentence("02,WV?") + "\r\n");
}

/// The machine was busy, and nobody read for a while: what is there then is the answer all the same.
TEST_F(NmeaSensorTest, TakesAnAnswerThatWaitedToBeRead) {
  make_nmea({{"format", std::string("umb")}});
  far_end.on_request = [this](const std::string&) {
    far_end.send(nmea_line("WIMWV,230.6,R,003.4,N,A"));
    clock.advance(800ms);
  };
  run(10s);
  EXPECT_GE(sink.readings.size(), 9U);
  EXPECT_TRUE(sink.refusals.empty());
}

TEST_F(NmeaSensorTest, AsksADeadDeviceLessOften) {
  make_nmea({{"format", std::string("umb")}, {"poll_interval", 0.2}, {"silence_timeout", 3600.0}});
  run(60s);
  EXPECT_LE(far_end.written.size(), 30U);
  EXPECT_GE(far_end.written.size(), 20U);
  EXPECT_THAT(sink.last_detail(), HasSubstr("does not reply"));
}

TEST_F(NmeaSensorTest, SaysThatTheDeviceCannotMeasure) {
  make_nmea();
  for (int i = 0; i < 20; ++i) receive(nmea_line("WIMWV,,R,,M,V"));
  EXPECT_TRUE(sink.readings.empty());
  EXPECT_EQ(sink.count(decode::Refusal::kInvalid), 20);
  EXPECT_EQ(sink.last_state(), wind::LinkState::kConnected) << "it is there and speaks";
  EXPECT_THAT(sink.last_detail(), HasSubstr("reports that it cannot measure"));
}

TEST(NmeaSettings, RefuseWhatCannotWork) {
  const auto refusal = [](const ParameterValues::Map& given) -> std::string {
    try {
      nmea_sensor_settings_of(values_for("nmea", given));
    } catch (const std::runtime_error& error) {
      return error.what();
    }
    return "accepted";
  };
  EXPECT_THAT(refusal({}), HasSubstr("device: is missing"));
  EXPECT_THAT(refusal({{"device", std::string("x")}, {"baud", std::int64_t{9601}}}), HasSubstr("allowed: 300, 600"));
  EXPECT_THAT(refusal({{"transport", std::string("tcp")}}), HasSubstr("host: is missing"));
  EXPECT_THAT(refusal({{"transport", std::string("file")}}), HasSubstr("file: is missing"));
  EXPECT_THAT(refusal({{"device", std::string("x")}, {"sentences", std::string("MWV,GGA")}}),
              HasSubstr("no wind in \"GGA\""));
  EXPECT_THAT(refusal({{"device", std::string("x")}, {"poll_interval", 1.0}}), HasSubstr("request: is missing"));
  EXPECT_THAT(refusal({{"transport", std::string("udp")}, {"poll_interval", 1.0}}), HasSubstr("cannot send"));
  EXPECT_THAT(refusal({{"device", std::string("x")}, {"format", std::string("umb")}, {"address", std::string("1")}}),
              HasSubstr("two characters"));
  EXPECT_EQ(refusal({{"transport", std::string("udp")}}), "accepted");
}

}  // namespace
}  // namespace yuragi::drivers::text
