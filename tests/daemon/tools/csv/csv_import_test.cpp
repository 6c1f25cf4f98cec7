#include "daemon/tools/csv/csv_import.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>
#include <random>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "engine/base/units.hpp"
#include "tests/support/places.hpp"

namespace yuragi::daemon::tools::csv {
namespace {

using namespace std::chrono_literals;
using testing::ElementsAre;
using testing::HasSubstr;

struct Imported {
  std::vector<wind::Reading> readings;
  std::vector<std::string> sensors;
  std::vector<wind::StationQuantities> quantities;
  ImportReport report;
  std::string failure;
};

Imported import_text(const std::string& text, const ImportOptions& options = {}) {
  Imported imported;
  std::istringstream in(text);
  const auto report = import_csv(
      in, "a.csv", options,
      {.reading =
           [&](std::string_view sensor, const wind::Reading& reading) {
             imported.sensors.emplace_back(sensor);
             imported.readings.push_back(reading);
           },
       .quantities = [&](std::string_view,
                         const wind::StationQuantities& quantities) { imported.quantities.push_back(quantities); }});
  if (report) {
    imported.report = *report;
  } else {
    imported.failure = report.error().message;
  }
  return imported;
}

ImportOptions with_column(Role role, const std::string& name) {
  ImportOptions options;
  options.columns[static_cast<std::size_t>(role)] = name;
  return options;
}

TEST(CsvImport, TakesSpeedAndDirectionByTheirUsualNames) {
  const auto imported = import_text(
      "# a mast on a hill\n"
      "Timestamp,Wind Speed,Wind Direction,Gust\n"
      "2018-07-20T14:00:00Z,5.5,270,7.25\n"
      "\n"
      "2018-07-20T14:00:01Z,0.0,,\n");
  EXPECT_EQ(imported.failure, "");
  ASSERT_EQ(imported.readings.size(), 2U);
  EXPECT_EQ(imported.readings[0].speed_m_s, 5.5);
  EXPECT_EQ(imported.readings[0].direction_deg, 270.0);
  EXPECT_EQ(imported.readings[0].gust_m_s, 7.25);
  EXPECT_EQ(imported.readings[0].quality, wind::ReadingQuality::kGood);
  EXPECT_EQ(imported.readings[0].time.mono, MonoTime{});
  EXPECT_EQ(imported.readings[1].time.mono, MonoTime{1s});
  EXPECT_EQ(imported.readings[1].direction_deg, std::nullopt);
  EXPECT_EQ(imported.readings[1].gust_m_s, std::nullopt);
  EXPECT_THAT(imported.sensors, ElementsAre("imported", "imported"));
  EXPECT_EQ(imported.report.taken, 2U);
  EXPECT_EQ(imported.report.refused(), 0U);
  EXPECT_THAT(imported.report.columns, testing::Contains(HasSubstr("speed from \"Wind Speed\" (m/s, assumed")));
}

TEST(CsvImport, TurnsComponentsIntoWhereTheWindComesFrom) {
  // Toward the east: from the west.
  const std::string text = "time,u_ms,v_ms,w_ms\n0,3,0,9\n1,0,-4,9\n2,3,4,9\n3,0,0,9\n";
  const auto imported = import_text(text);
  ASSERT_EQ(imported.readings.size(), 4U);
  EXPECT_NEAR(*imported.readings[0].direction_deg, 270.0, 1e-9);
  EXPECT_NEAR(*imported.readings[1].direction_deg, 0.0, 1e-9);
  EXPECT_EQ(imported.readings[1].speed_m_s, 4.0);
  EXPECT_EQ(imported.readings[2].speed_m_s, 5.0);
  EXPECT_EQ(imported.readings[3].direction_deg, std::nullopt) << "a calm comes from nowhere";

  ImportOptions from;
  from.components_are_from = true;
  EXPECT_NEAR(*import_text(text, from).readings[0].direction_deg, 90.0, 1e-9);
}

TEST(CsvImport, UnderstandsUnitsInNamesAndAsAnOption) {
  const auto speed_of_header = [](const std::string& name) {
    const auto imported = import_text("time," + name + "\n0,10\n");
    return imported.readings.empty() ? -1.0 : imported.readings[0].speed_m_s;
  };
  EXPECT_EQ(speed_of_header("speed_m_s"), 10.0);
  EXPECT_EQ(speed_of_header("wind_speed_ms"), 10.0);
  EXPECT_EQ(speed_of_header("Wind Speed [m s-1]"), 10.0);
  EXPECT_DOUBLE_EQ(speed_of_header("windspeed_10m (km/h)"), 10.0 / 3.6);
  EXPECT_DOUBLE_EQ(speed_of_header("speed_kmh"), 10.0 / 3.6);
  EXPECT_DOUBLE_EQ(speed_of_header("WindSpd_kn"), 10.0 * kMetresPerSecondPerKnot);
  EXPECT_DOUBLE_EQ(speed_of_header("Wind Speed (kts)"), 10.0 * kMetresPerSecondPerKnot);
  EXPECT_DOUBLE_EQ(speed_of_header("wind speed mph"), 10.0 * kMetresPerSecondPerMph);

  ImportOptions knots;
  knots.unit = find_speed_unit("kn");
  const auto imported = import_text("time,u,v,gust\n0,10,0,20\n", knots);
  EXPECT_DOUBLE_EQ(imported.readings[0].speed_m_s, 10.0 * kMetresPerSecondPerKnot);
  EXPECT_DOUBLE_EQ(*imported.readings[0].gust_m_s, 20.0 * kMetresPerSecondPerKnot);
}

TEST(CsvImport, UnderstandsDirectionsInAllConventions) {
  const auto direction = [](const std::string& header, const std::string& text, const ImportOptions& options = {}) {
    const auto imported = import_text("time,speed," + header + "\n0,1," + text + "\n", options);
    return imported.readings.empty() ? std::nullopt : imported.readings[0].direction_deg;
  };
  EXPECT_EQ(direction("dir", "360"), 0.0);
  EXPECT_EQ(direction("dir", "-90"), 270.0);
  EXPECT_EQ(direction("dir", "nnw"), 337.5);
  EXPECT_EQ(direction("dir", "NaN"), std::nullopt);
  EXPECT_NEAR(direction("dir_rad", "3.14159265358979").value(), 180.0, 1e-9);
  ImportOptions options;
  options.direction_is_toward = true;
  EXPECT_EQ(direction("dir", "90", options), 270.0);
  EXPECT_EQ(direction("dir", "270", options), 90.0);
  options = {};
  options.direction_unit = DirectionUnit::kPoint16;
  EXPECT_EQ(direction("dir", "4", options), 90.0);
  EXPECT_EQ(direction("dir", "North"), 0.0);
}

TEST(CsvImport, ReadsSemicolonsTabsAndDecimalCommas) {
  for (const char separator : {';', '\t'}) {
    std::string text = "station,time,speed\r\nhill,0.5,3.25\r\n";
    std::replace(text.begin(), text.end(), ',', separator);
    std::replace(text.begin(), text.end(), '.', ',');
    const auto imported = import_text(text);
    ASSERT_EQ(imported.readings.size(), 1U);
    EXPECT_EQ(imported.readings[0].speed_m_s, 3.25);
    EXPECT_EQ(imported.readings[0].time.utc, UtcTime(500ms));
  }
}

TEST(CsvImport, ReadsQuotedFieldsAndAByteOrderMark) {
  const auto imported = import_text("\xEF\xBB\xBF\"time\",\"speed\",note\n\"0\",\"4.5\",\"gusty, cold\"\n");
  ASSERT_EQ(imported.readings.size(), 1U);
  EXPECT_EQ(imported.readings[0].speed_m_s, 4.5);
}

TEST(CsvImport, AQuoteWithinQuotesStandsTwice) {
  const auto imported = import_text("time;\"the \"\"true\"\" speed\";note\n0;\"4.5\";\"a; b\"\n",
                                    with_column(Role::kSpeed, "the \"true\" speed"));
  EXPECT_EQ(imported.failure, "");
  ASSERT_EQ(imported.readings.size(), 1U);
  EXPECT_EQ(imported.readings[0].speed_m_s, 4.5);
}

TEST(CsvImport, AColumnMayBeTwoThings) {
  auto options = with_column(Role::kSpeed, "wind");
  options.columns[static_cast<std::size_t>(Role::kGust)] = "wind";
  const auto imported = import_text("time,wind\n0,4.5\n", options);
  ASSERT_EQ(imported.readings.size(), 1U) << imported.failure;
  EXPECT_EQ(imported.readings[0].gust_m_s, 4.5);
}

TEST(CsvImport, TakesTheColumnsThatAreNamed) {
  ImportOptions options = with_column(Role::kSpeed, "AVG (20 M)");
  options.columns[static_cast<std::size_t>(Role::kTime)] = "when";
  const auto imported = import_text("When,Speed,Avg (20 m)\n0,1,2\n", options);
  ASSERT_EQ(imported.readings.size(), 1U);
  EXPECT_EQ(imported.readings[0].speed_m_s, 2.0);
}

TEST(CsvImport, SaysWhichColumnsThereAreWhenItFindsNoneThatFit) {
  EXPECT_THAT(import_text("a,b\n1,2\n").failure,
              testing::AllOf(HasSubstr("a.csv"), HasSubstr("a, b"), HasSubstr("--time")));
  EXPECT_THAT(import_text("time,b\n1,2\n").failure, HasSubstr("--speed"));
  EXPECT_THAT(import_text("time,u\n1,2\n").failure, HasSubstr("--speed"));
  EXPECT_THAT(import_text("time,speed\n1,2\n", with_column(Role::kGust, "peak")).failure, HasSubstr("\"peak\""));
  EXPECT_THAT(import_text("time,speed,speed\n1,2,3\n").failure, HasSubstr("uplicated"));
  EXPECT_THAT(import_text("").failure, HasSubstr("header"));
  EXPECT_THAT(import_text("# nothing\n\n").failure, HasSubstr("header"));
}

TEST(CsvImport, LeavesOutBadRowsAndTellsTheFirstFew) {
  const auto imported = import_text(
      "time,speed,direction\n"
      "0,1,90\n"
      "1,abc,90\n"        // line 3
      "2,-1,90\n"         // line 4
      "3,,90\n"           // line 5
      "4,1\n"             // line 6
      "5,1,90,7\n"        // line 7
      "yesterday,1,90\n"  // line 8
      "6,1,\"90\n"
      "7,130,90\n"
      "0.5,nan,90\n"
      "8,1,90\n");
  EXPECT_EQ(imported.report.rows, 11U);
  EXPECT_EQ(imported.report.taken, 2U);
  EXPECT_THAT(
      imported.report.first_refusals,
      ElementsAre("a.csv:3: not a number in speed: \"abc\"", "a.csv:4: speed below zero: \"-1\"", "a.csv:5: no speed",
                  "a.csv:6: fewer fields than the header", "a.csv:7: more fields than the header"));
}

TEST(CsvImport, LeavesOutRowsThatGoBackInTime) {
  const auto imported = import_text("time,speed\n10,1\n12,2\n11,3\n12,4\n13,5\n");
  EXPECT_EQ(imported.report.refused(), 1U);
  EXPECT_EQ(imported.report.first_refusals.at(0), "a.csv:4: time goes back: \"11\"");
  EXPECT_EQ(imported.readings.back().time.mono, MonoTime{3s});
}

TEST(CsvImport, StrictEndsAtTheFirstBadRow) {
  ImportOptions options;
  options.strict = true;
  EXPECT_EQ(import_text("time,speed\n0,1\n1,x\n2,1\n", options).failure, "a.csv:3: not a number in speed: \"x\"");
  EXPECT_EQ(import_text("time,speed\n0,1\n1,1\n", options).report.taken, 2U);
}

TEST(CsvImport, SettlesTheTimeFormatWithTheFirstGoodRow) {
  const auto imported = import_text("time,speed\n99999999,1\n100000001,1\n");
  EXPECT_EQ(imported.report.taken, 2U);
  EXPECT_EQ(imported.readings[1].time.mono, MonoTime{2s});

  const auto milliseconds = import_text("time_ms,speed\n0,1\n100,1\n");
  ASSERT_EQ(milliseconds.readings.size(), 2U);
  EXPECT_EQ(milliseconds.readings[1].time.mono, MonoTime{100ms});
}

TEST(CsvImport, PassesOverTheCommentsThatItIsTold) {
  ImportOptions options;
  options.comment = '%';
  EXPECT_EQ(import_text("% mast\ntime,speed\n% pause\n0,1\n", options).report.rows, 1U);
  options.comment = 0;
  EXPECT_EQ(import_text("time,speed\n0,1\n#1,1\n", options).report.refused(), 1U);
}

TEST(CsvImport, ReadsALargeFileWithoutALastLineEnd) {
  std::string text = "time,speed,note\n";
  const std::string note(1000, 'x');
  constexpr std::size_t kRows = 34'000;
  for (std::size_t i = 0; i < kRows; ++i) text += std::to_string(i) + ",1," + note + "\n";
  text.pop_back();
  EXPECT_EQ(import_text(text).report.taken, kRows);
}

TEST(CsvImport, GivesUpOnALineWithoutEnd) {
  EXPECT_NE(import_text("time,speed\n0,1\n" + std::string((1 << 24) + 10, '1')).failure, "");
  EXPECT_THAT(import_text(std::string(2 << 20, 'x')).failure, HasSubstr("megabyte"));
}

std::vector<std::optional<double>> directions_of(const Imported& imported) {
  std::vector<std::optional<double>> directions;
  for (const wind::Reading& reading : imported.readings) directions.push_back(reading.direction_deg);
  return directions;
}

std::vector<double> speeds_of(const Imported& imported) {
  std::vector<double> speeds;
  for (const wind::Reading& reading : imported.readings) speeds.push_back(reading.speed_m_s);
  return speeds;
}

TEST(CsvImport, AMissingDirectionLeavesTheSpeedIn) {
  const auto imported = import_text(
      "time,speed,dir\n0,1,---\n1,2,M\n2,3,VRB\n3,4,Calm\n4,5,-999\n5,6,999\n6,7,990\n7,8,400\n8,9,up\n9,10,45\n");
  EXPECT_EQ(imported.report.refused(), 0U);
  EXPECT_THAT(speeds_of(imported), ElementsAre(1, 2, 3, 4, 5, 6, 7, 8, 9, 10));
  const std::vector<std::optional<double>> directions = directions_of(imported);
  EXPECT_TRUE(std::all_of(directions.begin(), directions.end() - 1, [](const auto& each) { return !each; }));
  EXPECT_EQ(directions.back(), 45.0);
  EXPECT_THAT(imported.report.notes,
              testing::IsSupersetOf({HasSubstr("direction: 7 values left empty"),
                                     HasSubstr("\"400\" is not a direction"), HasSubstr("\"up\" is not a direction")}));
}

TEST(CsvImport, AMarkForNoValueIsNoStorm) {
  const auto imported =
      import_text("time,speed,gust\n0,4.5,7\n1,99.0,99.0\n2,5.5,8\n3,99.0,99.0\n4,-999,9\n5,5,9999\n");
  EXPECT_THAT(speeds_of(imported), ElementsAre(4.5, 5.5, 5.0));
  EXPECT_EQ(imported.readings[2].gust_m_s, std::nullopt);
  EXPECT_THAT(imported.report.notes,
              testing::Contains(HasSubstr("99 in \"speed\" is treated as a missing value: it occurs 2 times")));

  // In km/h it is a gale like those beside it.
  const auto gale = import_text("time,speed (km/h)\n0,90\n1,99\n2,97\n3,99\n");
  EXPECT_EQ(gale.report.taken, 4U);
  EXPECT_THAT(gale.report.notes, testing::Contains(HasSubstr("--missing 99")));

  ImportOptions options;
  options.missing = {"7.7"};
  EXPECT_THAT(speeds_of(import_text("time,speed\n0,1\n1,7.7\n2,7.71\n", options)), ElementsAre(1.0, 7.71));
}

TEST(CsvImport, WhatCanBeIsNoMarkForNoValue) {
  // Tenths of degrees and of hPa, and cm/s.
  const auto imported = import_text(
      "# T : Temperature (in 0.1 degrees Celsius)\n# P : pressure (in 0.1 hPa)\n# ts,speed (cm/s),T,P\n"
      "1532095200,999,-99,9999\n1532095260,100,-9999,99999\n");
  EXPECT_THAT(speeds_of(imported), ElementsAre(testing::DoubleEq(9.99), 1.0)) << imported.failure;
  ASSERT_EQ(imported.quantities.size(), 1U);
  EXPECT_NEAR(*imported.quantities[0].air_temperature_c, -9.9, 1e-12);
  EXPECT_NEAR(*imported.quantities[0].pressure_hpa, 999.9, 1e-12);
}

TEST(CsvImport, AFileWithoutAHeaderIsGivenOne) {
  EXPECT_THAT(import_text("2023-01-01 10:00,3.5,270\n").failure, HasSubstr("--header"));
  ImportOptions options;
  options.header = {"time", "", "speed_kn", "dir"};
  const auto imported = import_text("2023-01-01 10:00,7,10,270\n2023-01-01 10:10,7,20,280\n", options);
  ASSERT_EQ(imported.readings.size(), 2U) << imported.failure;
  EXPECT_DOUBLE_EQ(imported.readings[1].speed_m_s, 20.0 * kMetresPerSecondPerKnot);
  EXPECT_EQ(imported.readings[1].direction_deg, 280.0);
}

TEST(CsvImport, EachColumnHasAUnitOfItsOwn) {
  const auto imported = import_text("time,speed (km/h),gust (mph)\n0,36,30\n");
  EXPECT_DOUBLE_EQ(imported.readings[0].speed_m_s, 10.0);
  EXPECT_DOUBLE_EQ(*imported.readings[0].gust_m_s, 30.0 * kMetresPerSecondPerMph);

  const auto beside = import_text("time,speed (km/h),gust\n0,36,72\n");
  EXPECT_DOUBLE_EQ(*beside.readings[0].gust_m_s, 20.0);
  EXPECT_THAT(beside.report.columns,
              testing::Contains(HasSubstr("gust from \"gust\" (km/h, as \"speed (km/h)\" beside it)")));

  const auto fields = import_text("time,speed,gust\n0,10 kn,20 kn\n");
  EXPECT_DOUBLE_EQ(fields.readings.at(0).speed_m_s, 10.0 * kMetresPerSecondPerKnot);
  ImportOptions options;
  options.gust_unit = find_speed_unit("m/s");
  EXPECT_DOUBLE_EQ(*import_text("time,speed (km/h),gust\n0,36,12\n", options).readings[0].gust_m_s, 12.0);
}

TEST(CsvImport, AUnitThatCannotBeRightIsAskedFor) {
  std::string strong = "time,speed\n";
  std::string weak_gusts = "time,speed (km/h),gust\n";
  for (int i = 0; i < 20; ++i) {
    strong += std::to_string(i) + "," + std::to_string(20 + i % 5) + "\n";
    weak_gusts += std::to_string(i) + "," + std::to_string(20 + i % 5) + "," + std::to_string(8 + i % 3) + "\n";
  }
  EXPECT_THAT(import_text(strong).failure, HasSubstr("--unit"));
  EXPECT_THAT(import_text(weak_gusts).failure, HasSubstr("--gust-unit"));
  ImportOptions options;
  options.unit = find_speed_unit("km/h");
  EXPECT_EQ(import_text(strong, options).report.taken, 20U);
}

TEST(CsvImport, DigitsAreADateWhereAllOfThemCanBeOne) {
  const auto hours = import_text("MESS_DATUM;F;D\n2018072014;1;10\n2018072015;2;20\n");
  EXPECT_EQ(hours.readings.at(0).time.utc, UtcTime(std::chrono::seconds(1'532'095'200)));
  EXPECT_EQ(hours.readings.at(1).time.mono, MonoTime{1h});
  const auto minutes = import_text("MESS_DATUM;FF_10;DD_10\n201807201400;1;10\n201807201410;2;20\n");
  EXPECT_EQ(minutes.readings.at(1).time.mono, MonoTime{10min});
  // Seconds since 1970 of 2033 that cannot all be dates.
  const auto unix_times = import_text("time,speed\n2018072014,1\n2018072074,2\n");
  EXPECT_EQ(unix_times.readings.at(1).time.mono, MonoTime{60s});
}

TEST(CsvImport, WhichNumberIsTheDayIsSettledByAllRowsOrAskedFor) {
  const auto day_first = import_text("time,speed\n3/4/2023 10:00,1\n13/4/2023 10:00,2\n");
  EXPECT_EQ(day_first.readings.at(1).time.mono, MonoTime{240h});
  const auto month_first = import_text("time,speed\n4/3/2023 10:00 AM,1\n4/13/2023 10:00 AM,2\n");
  EXPECT_EQ(month_first.readings.at(1).time.mono, MonoTime{240h});
  const auto by_order = import_text("time,speed\n31/1/2023,1\n1/2/2023,2\n");
  EXPECT_EQ(by_order.readings.at(1).time.mono, MonoTime{24h});
  EXPECT_THAT(import_text("time,speed\n3/4/2023,1\n4/4/2023,1\n").failure,
              HasSubstr("--time-format day-first or month-first"));
  EXPECT_EQ(import_text("time,speed\n3.4.2023,1\n4.4.2023,1\n").readings.at(1).time.mono, MonoTime{24h});
  ImportOptions options;
  options.time_format = TimeFormat::kMonthFirst;
  EXPECT_EQ(import_text("time,speed\n3/4/2023,1\n4/4/2023,1\n", options).readings.at(1).time.mono, MonoTime{31 * 24h});
}

TEST(CsvImport, TheHourThatComesTwiceIsNotLostWithAZone) {
  const std::string text =
      "time,speed\n2023-10-29 01:30,1\n2023-10-29 02:00,2\n2023-10-29 02:30,3\n2023-10-29 02:00,4\n2023-10-29 02:30,5\n"
      "2023-10-29 03:00,6\n";
  const auto without = import_text(text);
  EXPECT_EQ(without.report.refused(), 1U);
  EXPECT_THAT(without.report.notes, testing::Contains(HasSubstr("--zone")));
  ImportOptions options;
  options.zone = Zone::parse("Europe/Berlin").value();
  const auto with = import_text(text, options);
  EXPECT_EQ(with.report.refused(), 0U);
  EXPECT_EQ(with.readings.at(5).time.mono, MonoTime{150min});
}

TEST(CsvImport, RowsThatComeTwiceAreTakenOnce) {
  const auto imported = import_text("time,speed\n0,1\n1,2\n1,2\n2,3\n2,4\n");
  EXPECT_THAT(speeds_of(imported), ElementsAre(1, 2, 3, 4));
  EXPECT_THAT(imported.report.notes,
              testing::IsSupersetOf({HasSubstr("the same row as the one before: left out, 1 row"),
                                     HasSubstr("the same time as the one before: 1 reading")}));
}

TEST(CsvImport, AFileWithItsNewestRowFirstIsReadFromItsEnd) {
  const auto imported =
      import_text("time,speed\n2023-01-01 12:00,4\n2023-01-01 11:00,3\n2023-01-01 10:00,x\n2023-01-01 09:00,1");
  EXPECT_THAT(speeds_of(imported), ElementsAre(1, 3, 4));
  EXPECT_THAT(imported.report.first_refusals, ElementsAre("a.csv:4: not a number in speed: \"x\""));
}

TEST(CsvImport, WhatStationsSayBesidesTheWindIsKept) {
  const auto imported =
      import_text("time,u_ms,v_ms,w_ms,temp (F),baro (inHg),humidity,note\n0,3,0,-0.25,50,29.92,60,hm\n1,3,0,80,,,,\n");
  ASSERT_EQ(imported.quantities.size(), 1U);
  EXPECT_EQ(imported.quantities[0].vertical_speed_m_s, -0.25);
  EXPECT_NEAR(*imported.quantities[0].air_temperature_c, 10.0, 1e-12);
  EXPECT_NEAR(*imported.quantities[0].pressure_hpa, 1013.21, 0.005);
  EXPECT_EQ(imported.quantities[0].relative_humidity_percent, 60.0);
  EXPECT_THAT(imported.report.columns, testing::Contains("not taken: note"));
  EXPECT_THAT(imported.report.notes, testing::Contains(HasSubstr("weather: 1 value left out")));
}

TEST(CsvImport, ConditionsTakeOneOfSeveralStations) {
  ImportOptions options;
  options.conditions = {{"STATION", "b"}};
  const auto imported = import_text("station,time,speed\na,0,1\nb,0,2\na,1,3\nb,1,4\n", options);
  EXPECT_THAT(speeds_of(imported), ElementsAre(2, 4));
  EXPECT_EQ(imported.report.rows, 2U);
  options.conditions = {{"town", "b"}};
  EXPECT_THAT(import_text("station,time,speed\na,0,1\n", options).failure, HasSubstr("--where"));
}

TEST(CsvImport, LinesBeforeTheHeaderAreFoundOrSkipped) {
  const auto found = import_text("my station\n\nfirmware,2\ntime,speed\n0,1\n");
  EXPECT_THAT(speeds_of(found), ElementsAre(1));
  ImportOptions options;
  options.skip = 2;
  const auto skipped = import_text("time,speed\n9,9\ntime,speed\n0,1\n", options);
  EXPECT_THAT(speeds_of(skipped), ElementsAre(1));
  EXPECT_EQ(skipped.report.rows, 1U);
}

/// A stream that cannot go back, as a pipe.
class OneWayBuffer : public std::stringbuf {
 public:
  explicit OneWayBuffer(const std::string& text) : std::stringbuf(text, std::ios::in) {}

 private:
  pos_type seekoff(off_type, std::ios_base::seekdir, std::ios_base::openmode) override {
    return pos_type(off_type(-1));
  }
  pos_type seekpos(pos_type, std::ios_base::openmode) override { return pos_type(off_type(-1)); }
};

TEST(CsvImport, APipeIsReadAsAFileIsAndKeptOnlyInPart) {
  const std::string row = "," + std::string(1000, 'x') + "\n";
  std::string text = "time,speed,note\n";
  std::size_t rows = 0;
  while (text.size() < Input::kMaxKept + 100'000) text += std::to_string(rows++) + ",1" + row;
  OneWayBuffer buffer(text);
  std::istream in(&buffer);
  std::size_t taken = 0;
  const auto report = import_csv(in, "-", {}, {.reading = [&](std::string_view, const wind::Reading&) { ++taken; }});
  ASSERT_TRUE(report) << report.error().message;
  EXPECT_EQ(taken, rows);
  EXPECT_EQ(report->refused(), 0U);
  EXPECT_THAT(report->notes, testing::Contains(HasSubstr("the first 32 MiB")));
}

TEST(CsvImport, OfAnyBytesEndsWithReadingsOrAFailure) {
  std::mt19937 random(11);
  const std::string signs = "0123456789.,;-+:TZe \t\"'#\n\r\xEF\xFF" + std::string(1, '\0');
  for (int i = 0; i < 100; ++i) {
    std::string text = i % 3 == 0 ? "" : "time,speed,direction\n0,1,2\n";
    const std::size_t length = random() % 300;
    for (std::size_t j = 0; j < length; ++j) text += signs[random() % signs.size()];
    const auto imported = import_text(text);
    if (imported.failure.empty()) {
      EXPECT_EQ(imported.readings.size(), imported.report.taken);
    }
    for (const wind::Reading& reading : imported.readings) EXPECT_TRUE(wind::is_plausible(reading));
  }
}

TEST(CsvImport, OfTheFinseSonicNeedsNoOptions) {
  const std::string file = test::source_path("../shared/data/sonic/finse_csat3_10hz_20180720T140000.csv");
  std::ifstream in(file);
  if (!in) GTEST_SKIP() << file << " is not here";
  double sum = 0.0;
  double max = 0.0;
  Instant last;
  const auto report = import_csv(in, "finse.csv", {}, {.reading = [&](std::string_view, const wind::Reading& reading) {
                                   sum += reading.speed_m_s;
                                   max = std::max(max, reading.speed_m_s);
                                   last = reading.time;
                                 }});
  ASSERT_TRUE(report) << report.error().message;
  EXPECT_EQ(report->taken, 18'000U);
  EXPECT_EQ(report->refused(), 0U);
  EXPECT_NEAR(sum / 18'000.0, 7.02, 0.005);
  EXPECT_NEAR(max, 11.27, 0.005);
  EXPECT_EQ(last.mono, MonoTime{1'799'900ms});
}

/// The speed of the first row, and the failure.
Imported import_speed(const std::string& name, const std::string& unit_row, const std::string& value,
                      const ImportOptions& options = {}) {
  return import_text("time," + name + "\n" + (unit_row.empty() ? "" : "s," + unit_row + "\n") + "0," + value + "\n",
                     options);
}

TEST(CsvImport, ReadsTheRowOfUnitsWhole) {
  for (const auto& [word, metres_per_second] : std::map<std::string, double>{{"kilometers/hour", 1.0 / 3.6},
                                                                             {"knts", 1852.0 / 3600.0},
                                                                             {"mi/hr", 0.44704},
                                                                             {"feet/second", 0.3048},
                                                                             {"meter/sec", 1.0},
                                                                             {"Metres/Second", 1.0},
                                                                             {"dm/s", 0.1}}) {
    const auto imported = import_speed("WS", word, "10");
    ASSERT_EQ(imported.readings.size(), 1U) << word << imported.failure;
    EXPECT_NEAR(imported.readings[0].speed_m_s, 10.0 * metres_per_second, 1e-12) << word;
  }
  const auto beaufort = import_speed("WS", "Bft", "4");
  ASSERT_EQ(beaufort.readings.size(), 1U) << beaufort.failure;
  EXPECT_NEAR(beaufort.readings[0].speed_m_s, 0.836 * 8.0, 1e-12);
}

TEST(CsvImport, AWordThatIsNoKnownUnitIsAskedFor) {
  EXPECT_THAT(import_speed("WS", "furlongs", "10").failure, HasSubstr("the unit \"furlongs\" of column \"WS\""));
  EXPECT_THAT(import_speed("Wind Speed (furlongs)", "", "10").failure,
              HasSubstr("the unit \"furlongs\" of column \"Wind Speed (furlongs)\""));
  ImportOptions options;
  options.unit = find_speed_unit("kn");
  EXPECT_EQ(import_speed("WS", "furlongs", "10", options).failure, "");
  EXPECT_EQ(import_speed("Wind Speed (10 min avg)", "", "10").failure, "") << "no unit, but a remark";

  const std::string header = "time,speed,Wind Direction (pies)\n";
  EXPECT_THAT(import_text(header + "0,1,90\n").failure, HasSubstr("\"pies\""));
  const auto tens = import_text("time,speed,Wind Dir (10s deg)\n0,1,36\n1,1,9\n");
  ASSERT_EQ(tens.readings.size(), 2U) << tens.failure;
  EXPECT_EQ(tens.readings[0].direction_deg, 0.0);
  EXPECT_EQ(tens.readings[1].direction_deg, 90.0);
}

TEST(CsvImport, ADirectionIsNoSpeed) {
  EXPECT_THAT(import_text("time,Wind (deg)\n0,90\n").failure, HasSubstr("no column looks like a wind speed"));
}

TEST(CsvImport, ARowOfDataIsNoHeader) {
  const std::string bytes =
      "2018-02-14T15:55:07.944Z,2,130306,3,255,8,09,44,00,FF,fa,ff\n"
      "2018-02-14T15:55:08.044Z,2,130306,3,255,8,09,45,00,F,fa,ff\n";
  EXPECT_THAT(import_text(bytes).failure, HasSubstr("no header"));
  EXPECT_THAT(import_text("FF FA 3b A0 ff\nFF FA 3b A0 ff\n").failure, HasSubstr("no header"));
  const auto named = import_text("time;D1;F1\n0;90;5\n", with_column(Role::kSpeed, "F1"));
  EXPECT_EQ(named.readings.size(), 1U) << "names of two letters are no bytes: " << named.failure;
  // The first line that is above a row of its columns is offered.
  const auto preamble = import_text(
      "Site,hill,,,\nLogger,CR1000,serial,12,\nWhen,Spd80mN,Dir78mS,Spare A,Spare B\n"
      "2018-07-20T14:00:00Z,5.5,270,1,1\n");
  EXPECT_THAT(preamble.failure, HasSubstr("When, Spd80mN, Dir78mS"));
  // A legend names a time and a wind as well.
  const auto legend = import_text(
      "time,when the wind was measured\nwind speed,the mean of 10 minutes\ntime,wind speed,direction\n"
      "2018-07-20T14:00:00Z,5.5,270\n");
  ASSERT_EQ(legend.readings.size(), 1U) << legend.failure;
  EXPECT_EQ(legend.readings[0].direction_deg, 270.0);
}

TEST(CsvImport, FurtherColumnsThanTheGivenHeaderAreIgnored) {
  ImportOptions options;
  options.header = {"time", "speed"};
  const auto imported = import_text("2018-07-20T14:00:00Z,5.5,270,x\n", options);
  ASSERT_EQ(imported.readings.size(), 1U) << imported.failure;
  EXPECT_EQ(imported.readings[0].speed_m_s, 5.5);
}

UtcTime utc(int year, int month, int day, int hour, int minute = 0) {
  return UtcTime(std::chrono::sys_days(std::chrono::year(year) / month / day)) + std::chrono::hours(hour) +
         std::chrono::minutes(minute);
}

TEST(CsvImport, ReadsDayOfYearWithHoursAndMinutesInOneNumber) {
  std::string text = "Year,DOY,MST,Avg Wind Speed [m/s]\n";
  for (int minute = 0; minute < 130; ++minute)
    text += "2018,291," + std::to_string(minute / 60 * 100 + minute % 60) + ",2.5\n";
  const auto imported = import_text(text);
  ASSERT_EQ(imported.readings.size(), 130U) << imported.failure;
  EXPECT_EQ(imported.readings[0].time.utc, utc(2018, 10, 18, 7)) << "MST is seven hours behind";
  EXPECT_EQ(imported.readings[61].time.utc, utc(2018, 10, 18, 8, 1));
  EXPECT_EQ(imported.readings[129].time.mono, MonoTime{129min});
}

TEST(CsvImport, ReadsDayOfYearWithHours) {
  const auto imported = import_text("year,doy,hour,speed\n2018,1,23,1\n2018,1,24,2\n2018,2,1,3\n");
  ASSERT_EQ(imported.readings.size(), 3U) << imported.failure;
  EXPECT_EQ(imported.readings[1].time.utc, utc(2018, 1, 2, 0));
  EXPECT_EQ(imported.readings[2].time.utc, utc(2018, 1, 2, 1));
}

TEST(CsvImport, NumbersWithoutADateAreSecondsOnlyIfTheyCanBe) {
  const auto failure = [](const std::string& name, std::initializer_list<const char*> times) {
    std::string text = name + ",speed\n";
    for (const char* const time : times) text += std::string(time) + ",2\n";
    return import_text(text).failure;
  };
  EXPECT_THAT(failure("time", {"0", "1", "2", "59", "100", "101"}), HasSubstr("hours and minutes"));
  EXPECT_THAT(failure("time", {"22", "23", "24", "1", "2"}), HasSubstr("they begin again"));
  EXPECT_THAT(failure("time", {"2018", "2018", "2018", "2018"}), HasSubstr("do not grow"));
  EXPECT_THAT(failure("time", {"1", "2", "9", "40", "41", "60.5", "62", "80", "99", "120", "121", "150"}),
              HasSubstr("uneven"));
  EXPECT_THAT(failure("time", {"1", "9000000000", "-9000000000", "2", "-9000000000", "3", "-9000000000"}),
              HasSubstr("no seconds"));
  EXPECT_EQ(failure("time", {"0", "0.1", "0.2", "0.3", "0.4"}), "");
  EXPECT_EQ(failure("time_s", {"1", "2", "9", "40", "41", "200.5"}), "") << "its name states it";
}

TEST(CsvImport, PutsATypicalYearOnOneYear) {
  const auto imported = import_text(
      "Date (MM/DD/YYYY),Time (HH:MM),Wspd (m/s)\n01/31/1988,23:00,1\n01/31/1988,24:00,2\n02/01/1979,01:00,3\n"
      "02/28/1979,24:00,4\n03/01/1983,01:00,5\n12/31/1985,23:00,6\n12/31/1985,24:00,7\n");
  ASSERT_EQ(imported.readings.size(), 7U) << imported.failure;
  EXPECT_EQ(imported.readings[0].time.utc, utc(1989, 1, 31, 23));
  EXPECT_EQ(imported.readings[1].time.utc, utc(1989, 2, 1, 0));
  EXPECT_EQ(imported.readings[2].time.utc, utc(1989, 2, 1, 1));
  EXPECT_EQ(imported.readings[4].time.utc, utc(1989, 3, 1, 1));
  EXPECT_EQ(imported.readings[6].time.utc, utc(1990, 1, 1, 0)) << "the last hour of the year";
  EXPECT_THAT(imported.report.notes, testing::Contains(HasSubstr("a typical year")));
  // The change to winter time is none.
  const auto winter =
      import_text("time,speed\n2021-10-31 01:30,1\n2021-10-31 02:30,2\n2021-10-31 02:00,3\n2021-10-31 03:00,4\n");
  EXPECT_THAT(winter.report.notes, testing::Not(testing::Contains(HasSubstr("a typical year"))));
}

TEST(CsvImport, RowsThatAreLeftOutAreCountedByReason) {
  const auto imported = import_text(
      "time,speed\n2021-10-31T01:00Z,1\n2021-10-31T01:01Z,x\n2021-10-31T01:02Z,y\n2021-10-31T00:59Z,2\n"
      "2021-10-31T01:03Z\n");
  EXPECT_EQ(imported.report.refusals,
            (std::map<std::string, std::size_t>{
                {"fewer fields than the header", 1}, {"not a number in speed", 2}, {"time goes back", 1}}));
}

TEST(CsvImport, ATrackOfAGpsIsNoWind) {
  const std::string track = "time,lat,lon,ele,speed,course\n2021-10-31T01:00Z,52.1,13.1,40,1.4,90\n";
  EXPECT_THAT(import_text(track).failure, HasSubstr("GPS"));
  EXPECT_EQ(import_text(track, with_column(Role::kSpeed, "speed")).failure, "");
}

TEST(CsvImport, KnowsGustsInOtherLanguages) {
  for (const char* const name : {"Böe(km/h)", "Rafale (km/h)", "Raffica (km/h)", "Racha (km/h)", "Windstoot (km/h)"}) {
    const auto imported = import_text("time,Wind (km/h)," + std::string(name) + "\n0,3.6,7.2\n");
    ASSERT_EQ(imported.readings.size(), 1U) << name << imported.failure;
    EXPECT_EQ(imported.readings[0].gust_m_s, 2.0) << name;
  }
}

TEST(CsvImport, ReadsTheChannelsOfAnNrgLogger) {
  const std::string header = "Timestamp\tCh1_Samples_V\tCh12_Samples_Deg\tCh101_Samples_m/s\tCh401_Samples_m/s\n";
  const std::string row = "2024-01-11T13:39:30Z\t12.5\t336.6\t1.6\t1.8\n";
  const auto paired = import_text("Channel:\t12\nUnits:\tDeg\nGust Source Channel:\t401\n\n" + header + row);
  ASSERT_EQ(paired.readings.size(), 1U) << paired.failure;
  EXPECT_EQ(paired.readings[0].speed_m_s, 1.8);
  EXPECT_EQ(paired.readings[0].direction_deg, 336.6);
  const auto first = import_text("Channel:\t12\nUnits:\tDeg\n\n" + header + row);
  ASSERT_EQ(first.readings.size(), 1U) << first.failure;
  EXPECT_EQ(first.readings[0].speed_m_s, 1.6);
}

TEST(CsvImport, ReadsEnergyPlusWeather) {
  std::string text =
      "LOCATION,Berlin,-,DEU,TMY,103840,52.47,13.4,1.0,49.0\nDESIGN CONDITIONS,0\nDATA PERIODS,1,1,Data\n";
  const auto row = [](int hour, double direction_deg, double speed_m_s) {
    std::string line = "1999,1,1," + std::to_string(hour) + ",60,?9?9,-1.5,-3.0,80,101300";
    for (int field = 10; field < 20; ++field) line += ",0";
    return line + "," + std::to_string(direction_deg) + "," + std::to_string(speed_m_s) + ",5,5,16,77777\n";
  };
  text += row(1, 250.0, 3.5) + row(24, 260.0, 4.5);
  const auto imported = import_text(text);
  ASSERT_EQ(imported.readings.size(), 2U) << imported.failure;
  EXPECT_EQ(imported.readings[0].time.utc, utc(1999, 1, 1, 0)) << "an hour ahead of UTC";
  EXPECT_EQ(imported.readings[0].direction_deg, 250.0);
  EXPECT_EQ(imported.readings[1].speed_m_s, 4.5);
  EXPECT_EQ(imported.readings[1].time.utc, utc(1999, 1, 1, 23));
  EXPECT_NEAR(*imported.quantities[0].pressure_hpa, 1013.0, 1e-9);
}

TEST(CsvImport, ReadsCumulusWithAGivenUnit) {
  std::string row = "01/02/21,00:10,5.1,87,3.1,4.2,7.8,225";
  for (int field = 8; field < 28; ++field) row += ",0.0";
  EXPECT_THAT(import_text(row + "\n").failure, HasSubstr("CumulusMX writes no units"));
  ImportOptions options;
  options.unit = find_speed_unit("km/h");
  const auto imported = import_text(row + "\n", options);
  ASSERT_EQ(imported.readings.size(), 1U) << imported.failure;
  EXPECT_DOUBLE_EQ(imported.readings[0].speed_m_s, 4.2 / 3.6);
  EXPECT_DOUBLE_EQ(*imported.readings[0].gust_m_s, 7.8 / 3.6);
  EXPECT_EQ(imported.readings[0].direction_deg, 225.0);
  EXPECT_EQ(imported.readings[0].time.utc, utc(2021, 2, 1, 0, 10));
}

TEST(CsvImport, ReadsTheJapanMeteorologicalAgency) {
  const auto imported = import_text(
      "ダウンロードした時刻：2020/02/01 12:00:00\n\n,東京,東京,東京,東京,東京\n"
      "年月日時,風速(m/s),風速(m/s),風速(m/s),風速(m/s),風速(m/s)\n,,,風向,風向,\n,,品質情報,,品質情報,均質番号\n"
      "2020/1/1 1:00:00,2.9,8,北北西,8,1\n2020/1/1 2:00:00,0.2,8,静穏,8,1\n");
  ASSERT_EQ(imported.readings.size(), 2U) << imported.failure;
  EXPECT_EQ(imported.readings[0].speed_m_s, 2.9);
  EXPECT_EQ(imported.readings[0].direction_deg, 337.5);
  EXPECT_EQ(imported.readings[1].direction_deg, std::nullopt);
}

TEST(CsvImport, ReadsPvgisAndNasaPower) {
  const auto pvgis = import_text(
      "Latitude (decimal degrees): 45.000\r\nmonth,year\r\n1,2016\r\n2,2007\r\n"
      "time(UTC),T2m,RH,G(h),WS10m,WD10m,SP\r\n20160101:0000,4.4,91,0.0,1.52,201.0,100960.0\r\n"
      "20160131:2300,4.4,91,0.0,1.62,202.0,100960.0\r\n20070201:0000,5.0,90,0.0,1.72,203.0,100960.0\r\n");
  ASSERT_EQ(pvgis.readings.size(), 3U) << pvgis.failure;
  EXPECT_EQ(pvgis.readings[0].speed_m_s, 1.52);
  EXPECT_EQ(pvgis.readings[0].direction_deg, 201.0);
  EXPECT_EQ(pvgis.readings[2].time.utc - pvgis.readings[1].time.utc, 1h) << "of another year";

  const auto power = import_text(
      "-BEGIN HEADER-\nNASA/POWER Hourly\nWS10M     MERRA-2 Wind Speed at 10 Meters (m/s)\n-END HEADER-\n"
      "YEAR,MO,DY,HR,WS10M,WD10M\n2020,1,1,0,3.1,200.5\n2020,1,1,1,-999,-999\n");
  ASSERT_EQ(power.readings.size(), 1U) << power.failure;
  EXPECT_EQ(power.readings[0].speed_m_s, 3.1);
  EXPECT_EQ(power.readings[0].time.utc, utc(2020, 1, 1, 0));
}

TEST(CsvEncoding, IsFoundByTheBytes) {
  EXPECT_EQ(encoding_of("time,speed\n"), Encoding::kUtf8);
  EXPECT_EQ(encoding_of("Böe"), Encoding::kUtf8);
  EXPECT_EQ(encoding_of(std::string("B\xC3", 2)), Encoding::kUtf8) << "cut in two";
  EXPECT_EQ(encoding_of("B\xF6"
                        "e (km/h),Richtung (\xB0)"),
            Encoding::kLatin1);
  EXPECT_EQ(encoding_of("\x95\x97\x91\xAC(m/s),\x95\x97\x8C\xFC"), Encoding::kShiftJis);
  EXPECT_EQ(encoding_of(std::string("\xFF\xFEt\0i\0", 6)), Encoding::kUtf16Little);
  EXPECT_EQ(encoding_of(std::string("\0t\0i\0m\0e", 8)), Encoding::kUtf16Big);
}

TEST(CsvEncoding, AnotherOneIsConvertedAndCanBeReadTwice) {
  std::istringstream latin(
      "Zeit,B\xF6"
      "e\n1,2\n");
  Input input(latin);
  EXPECT_EQ(input.encoding(), Encoding::kLatin1);
  for (int pass = 0; pass < 2; ++pass) {
    std::string text;
    std::getline(pass == 0 ? input.first_pass() : input.second_pass(), text);
    EXPECT_EQ(text, "Zeit,Böe");
  }
  std::string wide;
  for (const char c : std::string("time,speed\n0,4.5\n")) wide += {c, '\0'};
  const auto imported = import_text("\xFF\xFE" + wide);
  ASSERT_EQ(imported.readings.size(), 1U) << imported.failure;
  EXPECT_EQ(imported.readings[0].speed_m_s, 4.5);
}

TEST(CsvForeign, WhatIsNoTextHasAName) {
  EXPECT_THAT(import_text("\x1F\x8B\x08 compressed").failure, HasSubstr("gzip"));
  EXPECT_THAT(import_text("\n<!DOCTYPE html><p>wind").failure, HasSubstr("web page"));
  EXPECT_THAT(import_text(std::string("time,speed\0\0\0", 13)).failure, HasSubstr("binary data"));
}

}  // namespace
}  // namespace yuragi::daemon::tools::csv
