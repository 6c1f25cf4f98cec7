#include "daemon/tools/csv/csv_time.hpp"

#include <limits>
#include <string>

#include <gtest/gtest.h>

#include "daemon/tools/csv/csv_zone.hpp"

namespace yuragi::daemon::tools::csv {
namespace {

using namespace std::chrono_literals;

/// The moment that a time is in UTC.
std::optional<UtcTime> utc_of(std::string_view text, TimeFormat format) {
  const auto time = parse_time(text, format);
  if (!time) return std::nullopt;
  return time->clock - time->utc_offset.value_or(Nanoseconds{0});
}

constexpr UtcTime kAfternoon{std::chrono::seconds(1'532'095'200)};  // 2018-07-20T14:00:00Z

TEST(CsvTime, ReadsIso8601) {
  EXPECT_EQ(utc_of("2018-07-20 14:00:00.5", TimeFormat::kIso), kAfternoon + 500ms);
  EXPECT_EQ(utc_of("1532095200", TimeFormat::kIso), std::nullopt);
  EXPECT_EQ(utc_of("1532095200", TimeFormat::kAuto), std::nullopt);
}

TEST(CsvTime, ReadsNumbersExactly) {
  EXPECT_EQ(utc_of("1532095200.1", TimeFormat::kUnix), kAfternoon + 100ms);
  EXPECT_EQ(utc_of("1532095200.123456789", TimeFormat::kUnix), kAfternoon + 123'456'789ns);
  EXPECT_EQ(utc_of("1532095200100", TimeFormat::kUnixMs), kAfternoon + 100ms);
  EXPECT_EQ(utc_of("1532095200100.25", TimeFormat::kUnixMs), kAfternoon + 100'250us);
  EXPECT_EQ(utc_of("0.3", TimeFormat::kSeconds), UtcTime(300ms));
  EXPECT_EQ(utc_of("99999999999999999999", TimeFormat::kUnix), std::nullopt);
  EXPECT_EQ(utc_of("9000000000", TimeFormat::kUnix), std::nullopt) << "beyond what a recording holds";
}

TEST(CsvTime, DigitsAloneAreADayAndAnHourBeforeTheyAreSeconds) {
  EXPECT_EQ(utc_of("2018072014", TimeFormat::kCompact), kAfternoon);
  EXPECT_EQ(utc_of("201807201400", TimeFormat::kCompact), kAfternoon);
  EXPECT_EQ(utc_of("20180720140000", TimeFormat::kCompact), kAfternoon);
  EXPECT_EQ(utc_of("20180720", TimeFormat::kCompact), kAfternoon - 14h);
  EXPECT_EQ(utc_of("2018072024", TimeFormat::kCompact), kAfternoon + 10h) << "24 is the next day's first hour";
  for (const char* text : {"1532095200", "2018132014", "2018072025", "201807201460", "2018022900", "201807"}) {
    EXPECT_EQ(utc_of(text, TimeFormat::kCompact), std::nullopt) << text;
  }
}

TEST(CsvTime, ReadsDatesAsPeopleWriteThem) {
  for (const char* text :
       {"20/07/2018 14:00", "20.7.2018 14:00:00", "20-07-18 2:00 PM", "20/7/2018, 02:00:00 p.m.", "20-Jul-2018 14:00",
        "20 July 2018 14:00", "20.07.2018 14:00 UTC", "20.07.2018 16:00 +02:00"}) {
    EXPECT_EQ(utc_of(text, TimeFormat::kDayFirst), kAfternoon) << text;
  }
  for (const char* text : {"7/20/2018 14:00", "07/20/18 02:00:00 PM", "7/20/18 2:00p", "Jul 20, 2018 2:00 PM"}) {
    EXPECT_EQ(utc_of(text, TimeFormat::kMonthFirst), kAfternoon) << text;
  }
  for (const char* text : {"2018/7/20 14:00", "2018 07 20 14 00", "20180720 14", "20180720 1400", "20180720T140000Z",
                           "2018-07-20T16:00:00+0200", "2018-07-20 14:00:00 GMT", "2018-07-20 07:00:00 UTC-7"}) {
    EXPECT_EQ(utc_of(text, TimeFormat::kIso), kAfternoon) << text;
  }
  EXPECT_EQ(utc_of("7/20/18 12:00a", TimeFormat::kMonthFirst), kAfternoon - 14h) << "midnight";
  EXPECT_EQ(utc_of("7/20/18 12:00p", TimeFormat::kMonthFirst), kAfternoon - 2h) << "noon";
}

TEST(CsvTime, RefusesWhatIsNoTime) {
  for (const char* text :
       {"", "2018-02-29", "2018-07-20 24:01", "2018-07-20 14:60", "2018-07-20 13:00 PM", "2018-07-20 0:30 AM",
        "2018-07-20 14:00 CET", "2018-07-20 14:00+15:00", "2018-07-20 14:00:00+2:000", "14:00", "2018", "2018-07",
        "20/07/2018", "2018-07-20 14:00 x", "0000-00-00"}) {
    EXPECT_EQ(utc_of(text, TimeFormat::kIso), std::nullopt) << text;
  }
  EXPECT_EQ(utc_of("7/20/2018", TimeFormat::kDayFirst), std::nullopt);
  EXPECT_EQ(utc_of("20/7/2018", TimeFormat::kMonthFirst), std::nullopt);
}

TEST(CsvTime, SaysWhetherATextNamesItsZone) {
  EXPECT_EQ(parse_time("2018-07-20 14:00", TimeFormat::kIso)->utc_offset, std::nullopt);
  EXPECT_EQ(parse_time("2018-07-20 14:00Z", TimeFormat::kIso)->utc_offset, Nanoseconds{0});
  EXPECT_EQ(parse_time("2018-07-20 14:00-03:30", TimeFormat::kIso)->utc_offset, -210min);
  EXPECT_EQ(parse_time("1532095200", TimeFormat::kUnix)->utc_offset, Nanoseconds{0});
}

TEST(CsvTime, AZoneSortsTheHourThatComesTwice) {
  const auto zone = Zone::parse("Europe/Berlin");
  ASSERT_TRUE(zone) << zone.error().message;
  const auto clock = [](int hour, int minute) {
    return UtcTime(std::chrono::sys_days(std::chrono::year(2023) / 10 / 29)) + std::chrono::hours(hour) +
           std::chrono::minutes(minute);
  };
  const auto first = zone->to_utc(clock(2, 50), std::nullopt);
  EXPECT_EQ(first, clock(0, 50));
  EXPECT_EQ(zone->to_utc(clock(2, 0), first), clock(1, 0)) << "the first 2:00 would go back";
  EXPECT_EQ(zone->to_utc(clock(4, 0), first), clock(3, 0));
  const UtcTime left_out = UtcTime(std::chrono::sys_days(std::chrono::year(2023) / 3 / 26)) + 2h + 30min;
  EXPECT_EQ(zone->to_utc(left_out, std::nullopt), std::nullopt);
  EXPECT_EQ(Zone::parse("+02:00")->to_utc(clock(2, 0), std::nullopt), clock(0, 0));
  EXPECT_EQ(Zone::parse("UTC-7")->to_utc(clock(2, 0), std::nullopt), clock(9, 0));
  for (const char* text : {"", "Mars/Olympus", "+99:00", "noon", "../../etc/passwd"})
    EXPECT_FALSE(Zone::parse(text)) << text;
}

TEST(CsvTime, DecimalsAreKeptToTheLastDigit) {
  EXPECT_EQ(parse_decimal("1.25", 9), 1'250'000'000);
  EXPECT_EQ(parse_decimal("-1.25", 1), -12);
  EXPECT_EQ(parse_decimal("1,25", 2), 125);
  EXPECT_EQ(parse_decimal("+7", 0), 7);
  EXPECT_EQ(parse_decimal(".5", 3), 500);
  EXPECT_EQ(parse_decimal("5.", 3), 5000);
  EXPECT_EQ(parse_decimal("9223372036854775807", 0), std::numeric_limits<std::int64_t>::max());
  for (const char* text :
       {"", ".", "-", "+", "1e3", "0x10", "1.2.3", "1,532,095", "--1", " 1", "9223372036854775808"}) {
    EXPECT_EQ(parse_decimal(text, 0), std::nullopt) << text;
  }
  EXPECT_EQ(parse_decimal("9223372036854775807", 1), std::nullopt);
}

TEST(CsvTime, GuessesTheFormatFromWhatItSees) {
  EXPECT_EQ(guess_count_format("2018-07-20T14:00:00Z"), std::nullopt);
  EXPECT_EQ(guess_count_format("1532095200.1"), TimeFormat::kUnix);
  EXPECT_EQ(guess_count_format("1532095200100"), TimeFormat::kUnixMs);
  EXPECT_EQ(guess_count_format("1532095200100000"), TimeFormat::kUnixUs);
  EXPECT_EQ(guess_count_format("1532095200100000000"), TimeFormat::kUnixNs);
  EXPECT_EQ(guess_count_format("0.1"), TimeFormat::kSeconds);
  EXPECT_EQ(guess_count_format("86400"), TimeFormat::kSeconds);
}

}  // namespace
}  // namespace yuragi::daemon::tools::csv
