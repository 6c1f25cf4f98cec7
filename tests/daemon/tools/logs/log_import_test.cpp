// Logs of messages: which line has which wind, and when. The whole way, with files, is tests/e2e/csv_formats_test.py.
#include "daemon/tools/logs/log_import.hpp"

#include <random>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "daemon/tools/logs/log_time.hpp"

namespace yuragi::daemon::tools::logs {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;

constexpr UtcTime kEvening{std::chrono::seconds(1'687'730'400)};  // 2023-06-25T22:00:00Z

struct ImportedLog {
  std::vector<wind::Reading> readings;
  std::vector<wind::StationQuantities> quantities;
  csv::ImportReport report;
  std::string failure;
};

ImportedLog imported_from(const std::string& text, const Options& options = {}) {
  ImportedLog imported;
  std::istringstream in(text);
  csv::Input input(in);
  const auto report = import_log(
      input, "a.log", options,
      {.reading = [&](std::string_view, const wind::Reading& reading) { imported.readings.push_back(reading); },
       .quantities = [&](std::string_view,
                         const wind::StationQuantities& each) { imported.quantities.push_back(each); }});
  if (report) {
    imported.report = *report;
  } else {
    imported.failure = report.error().message;
  }
  return imported;
}

TEST(LogImport, TheClockOfNmeaNeedsADateAndGoesOverMidnight) {
  NmeaClock clock;
  EXPECT_FALSE(clock.take("$GPGLL,,,,,235959.50,A"));
  EXPECT_FALSE(clock.take("$GPRMC,235959.00,V,,,,,,,250623,,")) << "not valid";
  EXPECT_TRUE(clock.take("$GPRMC,235959.00,A,,,,,,,250623,,"));
  EXPECT_EQ(clock.now(), kEvening + 2h - 1s);
  EXPECT_TRUE(clock.take("$GPGLL,,,,,235959.50,A"));
  EXPECT_EQ(clock.now(), kEvening + 2h - 500ms);
  EXPECT_TRUE(clock.take("$GPGGA,000001,,,,,,"));
  EXPECT_EQ(clock.now(), kEvening + 2h + 1s);
  EXPECT_TRUE(clock.take("$GPZDA,220000.00,26,06,2023,00,00"));
  EXPECT_EQ(clock.now(), kEvening + 24h);
  EXPECT_FALSE(clock.take("$GPRMC,999999.00,A,,,,,,,250623,,"));
  EXPECT_FALSE(clock.take("$WIMWV,1.0,R,1.0,M,A"));
}

TEST(LogImport, TimesStandBeforeMessagesInManyWays) {
  for (const char* prefix : {"2023-06-25T22:00:00Z ", "2023-06-25 22:00:00, ", "[2023-06-25 22:00:00.000] ",
                             "1687730400 ", "(1687730400.000) can0 ", "1687730400000;A;", "\\s:x,c:1687730400*00\\",
                             "20230625 220000\t", "2023/06/25,22:00:00,"}) {
    const auto time = leading_time(prefix, csv::TimeFormat::kAuto);
    ASSERT_TRUE(time) << prefix;
    EXPECT_EQ(time->clock, kEvening) << prefix;
  }
  for (const char* prefix : {"", "x ", "12 ", "22:00:00 ", "3/4/2023 22:00 ", "wind: "}) {
    EXPECT_FALSE(leading_time(prefix, csv::TimeFormat::kAuto)) << prefix;
  }
  EXPECT_TRUE(leading_time("25/06/2023 22:00:00 ", csv::TimeFormat::kDayFirst));
}

TEST(LogImport, OneSentenceOfSeveralIsTaken) {
  const std::string text =
      "$GPRMC,220000,A,,,,,,,250623,,\n$WIMWV,10,R,5.0,M,A\n$WIMWD,100,T,,M,,,5.0,M\n$GPRMC,220001,A,,,,,,,250623,,\n"
      "$WIMWV,20,R,6.0,M,A\n$WIMWD,110,T,,M,,,6.0,M\n$WIXDR,C,21.5,C,0\n";
  const auto best = imported_from(text);
  ASSERT_EQ(best.readings.size(), 2U) << best.failure;
  EXPECT_EQ(best.readings[0].direction_deg, 100.0);
  EXPECT_EQ(best.readings[1].time.utc, kEvening + 1s);
  ASSERT_EQ(best.quantities.size(), 1U);
  EXPECT_EQ(best.quantities[0].air_temperature_c, 21.5);
  EXPECT_THAT(best.report.columns, testing::Contains(HasSubstr("not taken: MWV R of WI (2 of them")));
  Options options;
  options.sentence = "MWV R";
  EXPECT_EQ(imported_from(text, options).readings.at(1).direction_deg, 20.0);
  EXPECT_EQ(imported_from(text + "$WIMWV,30,R,7.0,M,A\n$WIMWV,40,R,7.0,M,A\n$WIMWV,50,R,7.0,M,A\n").readings.size(), 5U)
      << "a sentence that is said seldom is not the wind";
  options.sentence = "VWR";
  EXPECT_THAT(imported_from(text, options).failure, HasSubstr("VWR"));
}

TEST(LogImport, WithoutATimeItSaysWhichOptionsHelp) {
  const std::string text = "$WIMWV,10,R,5.0,M,A\n$WIMWV,20,R,6.0,M,A*00\n$WIMWV,30,R,7.0,M,A\n";
  EXPECT_THAT(imported_from(text).failure, testing::AllOf(HasSubstr("--start"), HasSubstr("--interval")));
  Options options;
  options.start = kEvening;
  options.interval = 250ms;
  const auto imported = imported_from(text, options);
  ASSERT_EQ(imported.readings.size(), 2U) << "a wrong checksum is refused";
  EXPECT_EQ(imported.readings[1].time.utc, kEvening + 250ms);
  EXPECT_THAT(imported_from("hello\n").failure, HasSubstr("no line has a wind"));
}

TEST(LogImport, IsToldFromATable) {
  EXPECT_TRUE(looks_like_log({"$WIMWV,10,R,5.0,M,A", "$GPRMC,220000,A,,,,,,,250623,,", "# note"}, {}));
  EXPECT_TRUE(looks_like_log({"\x02Q,270,002.74,M,00,\x03"}, {}));
  EXPECT_TRUE(looks_like_log({"2023-06-25 22:00 speed=4.2 direction=270"}, {}));
  EXPECT_FALSE(looks_like_log({"time,speed,direction", "0,1,2", "1,2,3"}, {}));
  EXPECT_FALSE(looks_like_log({}, {}));
}

TEST(LogImport, KeysNameTheWindAsColumnsDo) {
  const auto json = imported_from(
      R"({"time" : "2023-06-25 22:00:00", "model" : "WS80", "id" : 7, "wind_dir_deg" : 313, "wind_avg_km_h" : 7.2, "wind_max_m_s" : 3.0})"
      "\n"
      R"({"time" : "2023-06-25 22:00:05", "model" : "WS80", "id" : 7, "temperature_C" : 20.5})"
      "\n");
  ASSERT_EQ(json.readings.size(), 1U) << json.failure;
  EXPECT_EQ(json.readings[0].speed_m_s, 2.0);
  EXPECT_EQ(json.readings[0].direction_deg, 313.0);
  EXPECT_EQ(json.readings[0].gust_m_s, 3.0);
  EXPECT_EQ(json.readings[0].time.utc, kEvening);

  const auto pushed = imported_from(
      "GET /weatherstation/updateweatherstation.php?ID=x&dateutc=2023-06-25+22%3A00%3A00&windspeedmph=10&winddir=NW"
      "&windgustmph=-9999 HTTP/1.1\n");
  ASSERT_EQ(pushed.readings.size(), 1U) << pushed.failure;
  EXPECT_NEAR(pushed.readings[0].speed_m_s, 4.4704, 1e-12);
  EXPECT_EQ(pushed.readings[0].direction_deg, 315.0);
  EXPECT_EQ(pushed.readings[0].gust_m_s, std::nullopt);
  EXPECT_EQ(pushed.readings[0].time.utc, kEvening);

  const auto text = imported_from("2023-06-25T22:00:00Z Wind Speed: 15.1 km/h, Direction: 270 deg, Gust: nan\n");
  ASSERT_EQ(text.readings.size(), 1U) << text.failure;
  EXPECT_NEAR(text.readings[0].speed_m_s, 15.1 / 3.6, 1e-12);
  EXPECT_EQ(text.readings[0].direction_deg, 270.0);
}

TEST(LogImport, KeysAndUnitsCanBeGiven) {
  Options options;
  options.table.columns[static_cast<std::size_t>(csv::Role::kSpeed)] = "anemo";
  options.table.columns[static_cast<std::size_t>(csv::Role::kDirection)] = "vane";
  options.table.unit = csv::find_speed_unit("kn");
  const auto imported = imported_from("2023-06-25T22:00:00Z $,anemo=10,vane=90,speed=3\n", options);
  ASSERT_EQ(imported.readings.size(), 1U) << imported.failure;
  EXPECT_NEAR(imported.readings[0].speed_m_s, 10.0 * 1852.0 / 3600.0, 1e-12);
  EXPECT_EQ(imported.readings[0].direction_deg, 90.0);
}

TEST(LogImport, OneKeyALineIsAMessageForEachTurn) {
  Options options;
  options.start = kEvening;
  options.interval = 2s;
  const auto imported = imported_from(
      "WindDir      = 79\nWindSpeed    = 0.5\nWindGust     = 0.6\nGXTS04Temp   = 24.4\n"
      "WindDir      = 85\nWindSpeed    = 1.7\nWindGust     = 2.1\nGXTS04Temp   = 24.4\n",
      options);
  ASSERT_EQ(imported.readings.size(), 2U) << imported.failure;
  EXPECT_EQ(imported.readings[0].direction_deg, 79.0);
  EXPECT_EQ(imported.readings[0].gust_m_s, 0.6);
  EXPECT_EQ(imported.readings[1].speed_m_s, 1.7);
  EXPECT_EQ(imported.readings[1].direction_deg, 85.0);
  EXPECT_EQ(imported.readings[1].time.utc, kEvening + 2s);
}

TEST(LogImport, ReadsWhatStationsSendWithTheirTimes) {
  const auto wxt =
      imported_from("1687730400\t0R1,Dn=059D,Dm=066D,Dx=080D,Sn=8.5M,Sm=9.5M,Sx=10.3M\n1687730400\t0R2,Ta=13.9C\n");
  ASSERT_EQ(wxt.readings.size(), 1U) << wxt.failure;
  EXPECT_EQ(wxt.readings[0].speed_m_s, 9.5);
  EXPECT_EQ(wxt.readings[0].time.utc, kEvening);
  ASSERT_EQ(wxt.quantities.size(), 1U);

  const auto tempest =
      imported_from(R"({"serial_number":"ST-1","type":"device_status","hub_sn":"HB-1","timestamp":1687730399})"
                    "\n"
                    R"({"serial_number":"ST-1","type":"rapid_wind","hub_sn":"HB-1","ob":[1687730400,2.3,128]})"
                    "\n");
  ASSERT_EQ(tempest.readings.size(), 1U) << tempest.failure;
  EXPECT_EQ(tempest.readings[0].direction_deg, 128.0);
  EXPECT_EQ(tempest.readings[0].time.utc, kEvening);

  const auto davis = imported_from(
      R"({"did":"1","ts":1687730400,"conditions":[{"data_structure_type":1,"txid":1,"wind_speed_last":10,"wind_dir_last":90}]})"
      "\n");
  ASSERT_EQ(davis.readings.size(), 1U) << davis.failure;
  EXPECT_NEAR(davis.readings[0].speed_m_s, 4.4704, 1e-9);
  EXPECT_EQ(davis.readings[0].time.utc, kEvening);
}

TEST(LogImport, ATimeThatNoRecordingCanHaveIsNone) {
  for (const char* const ts : {"9223372036854775807", "1e300", "-9223372036854775808"}) {
    const std::string davis = std::string(R"({"did":"1","ts":)") + ts +
                              R"(,"conditions":[{"data_structure_type":1,"txid":1,"wind_speed_last":10}]})" + "\n";
    EXPECT_THAT(imported_from(davis).failure, HasSubstr("no time was found")) << ts;
  }
  const std::string tempest =
      R"({"serial_number":"ST-1","type":"rapid_wind","hub_sn":"HB-1","ob":[9000000000000000,2.3,128]})"
      "\n";
  EXPECT_TRUE(imported_from(tempest).readings.empty());
}

TEST(LogImport, ReadsNmea2000WithItsTimes) {
  const auto plain = imported_from(
      "2023-06-25T22:00:00.000Z,2,127250,3,255,8,ff,aa,00,ff,7f,ff,7f,fd\n"
      "2023-06-25T22:00:00.500Z,2,130306,3,255,8,09,f4,01,10,27,fa,ff,ff\n");
  ASSERT_EQ(plain.readings.size(), 1U) << plain.failure;
  EXPECT_EQ(plain.readings[0].speed_m_s, 5.0);
  EXPECT_NEAR(*plain.readings[0].direction_deg, 57.2957795, 1e-6) << "1.0000 rad";
  EXPECT_EQ(plain.readings[0].time.utc, kEvening + 500ms);
  EXPECT_THAT(plain.report.columns,
              testing::Contains(HasSubstr("NMEA 2000 (canboat-plain), relative: 1 wind in 2 lines")));

  const std::string raw =
      "23:59:59.500 R 09FD0203 09 F4 01 10 27 FA FF FF\n00:00:00.250 R 09FD0203 09 F4 01 10 27 FA FF FF\n";
  EXPECT_THAT(imported_from(raw).failure, HasSubstr("--start with the first day"));
  Options options;
  options.start = kEvening;
  const auto days = imported_from(raw, options);
  ASSERT_EQ(days.readings.size(), 2U) << days.failure;
  EXPECT_EQ(days.readings[0].time.utc, kEvening + 2h - 500ms);
  EXPECT_EQ(days.readings[1].time.utc, kEvening + 2h + 250ms);
}

TEST(LogImport, OfHurtLinesEndsWithPlausibleReadingsInOrder) {
  const std::string sound =
      "2023-06-25 22:00:00, $WIMWV,10,R,5.0,M,A*24\n$GPRMC,220000,A,,,,,,,250623,,\n\x02Q,270,002.74,M,00,\x03"
      "16\n"
      "2023-06-25T22:00:01Z speed=4.2 direction=270\n$ 28673 M 00400 12345\n$WI,WVP=020.0,045,0*73\n";
  std::mt19937 random(3);
  for (int i = 0; i < 300; ++i) {  // fuzz_line_log goes on with this
    std::string text = sound + sound;
    for (unsigned hurt = random() % 8; hurt > 0; --hurt) {
      const std::size_t at = random() % text.size();
      if (random() % 2 == 0) {
        text[at] = static_cast<char>(random());
      } else {
        text.erase(at, random() % 20);
      }
      if (text.empty()) break;
    }
    const auto imported = imported_from(text);
    MonoTime last{};
    for (const wind::Reading& reading : imported.readings) {
      EXPECT_TRUE(wind::is_plausible(reading));
      EXPECT_GE(reading.time.mono, last);
      last = reading.time.mono;
    }
  }
}

}  // namespace
}  // namespace yuragi::daemon::tools::logs
