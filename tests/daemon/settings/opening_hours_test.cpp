#include "daemon/settings/opening_hours.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace yuragi::daemon::settings {
namespace {

using namespace std::chrono_literals;
using ::testing::HasSubstr;

/// UTC.
UtcTime moment(int year, unsigned month, unsigned day, int hour, int minute) {
  const auto date = std::chrono::year(year) / std::chrono::month(month) / std::chrono::day(day);
  return std::chrono::sys_days(date) + std::chrono::hours(hour) + std::chrono::minutes(minute);
}

OpeningHours hours_of(const char* hours, const std::string& zone = "Etc/UTC") {
  return OpeningHours::parse(hours, zone).value();
}

// 2026-11-16 is a Monday.

TEST(OpeningHours, WithoutATextItIsAlwaysOpen) {
  for (const OpeningHours& hours : {OpeningHours(), hours_of(""), hours_of("  "), hours_of("00:00-24:00")}) {
    EXPECT_TRUE(hours.is_always_open());
    EXPECT_TRUE(hours.is_open(moment(2026, 11, 16, 3, 0)));
    EXPECT_EQ(hours.until_text(moment(2026, 11, 16, 3, 0)), "");
  }
}

TEST(OpeningHours, IsOpenFromTheFirstMinuteToTheLast) {
  const OpeningHours hours = hours_of("10:00-18:30");
  for (unsigned day = 16; day < 23; ++day) {
    EXPECT_FALSE(hours.is_open(moment(2026, 11, day, 10, 0) - 1ns));
    EXPECT_TRUE(hours.is_open(moment(2026, 11, day, 10, 0)));
    EXPECT_TRUE(hours.is_open(moment(2026, 11, day, 18, 30) - 1ns));
    EXPECT_FALSE(hours.is_open(moment(2026, 11, day, 18, 30)));
  }
}

TEST(OpeningHours, RulesAddUpDayByDay) {
  const OpeningHours hours = hours_of(" tue - SUN 10:00 - 18:00,Thu 18:00-21:00 , Sat-Mon 8:00-9:00");
  EXPECT_FALSE(hours.is_open(moment(2026, 11, 16, 12, 0))) << "Monday";
  EXPECT_TRUE(hours.is_open(moment(2026, 11, 16, 8, 30))) << "Saturday to Monday goes round the week";
  EXPECT_TRUE(hours.is_open(moment(2026, 11, 17, 12, 0))) << "Tuesday";
  EXPECT_FALSE(hours.is_open(moment(2026, 11, 17, 19, 0)));
  EXPECT_TRUE(hours.is_open(moment(2026, 11, 19, 19, 0))) << "Thursday";
  EXPECT_TRUE(hours.is_open(moment(2026, 11, 22, 12, 0))) << "Sunday";
  EXPECT_FALSE(hours.is_open(moment(2026, 11, 20, 8, 30))) << "Friday";
}

TEST(OpeningHours, ANightGoesOnIntoTheNextDay) {
  const OpeningHours hours = hours_of("Sun 20:00-02:00");
  EXPECT_TRUE(hours.is_open(moment(2026, 11, 22, 23, 59)));
  EXPECT_TRUE(hours.is_open(moment(2026, 11, 23, 1, 59))) << "Monday, and a new week";
  EXPECT_FALSE(hours.is_open(moment(2026, 11, 23, 2, 0)));
  EXPECT_FALSE(hours.is_open(moment(2026, 11, 22, 1, 0))) << "Sunday's own night begins in the evening";
}

TEST(OpeningHours, TellsTheNextChangeByTheClockOnTheWall) {
  const OpeningHours hours = hours_of("Tue-Fri 10:00-18:00");
  EXPECT_EQ(hours.until_text(moment(2026, 11, 17, 9, 59)), "until 10:00");
  EXPECT_EQ(hours.until_text(moment(2026, 11, 17, 10, 0)), "until 18:00");
  EXPECT_EQ(hours.until_text(moment(2026, 11, 17, 18, 0)), "until 10:00");
  EXPECT_EQ(hours.until_text(moment(2026, 11, 20, 18, 0)), "until Tue 10:00");
}

TEST(OpeningHours, KeepsToLocalTimeOverBothChangesOfTheClocks) {
  const OpeningHours berlin = hours_of("10:00-18:00", "Europe/Berlin");
  // Winter is UTC+1, summer UTC+2; the clocks changed on 29 March and 25 October 2026.
  for (const auto& [month, day, utc_hour] :
       {std::tuple{3U, 28U, 9}, {3U, 29U, 8}, {3U, 30U, 8}, {10U, 24U, 8}, {10U, 25U, 9}}) {
    EXPECT_FALSE(berlin.is_open(moment(2026, month, day, utc_hour, 0) - 1ns)) << month << ' ' << day;
    EXPECT_TRUE(berlin.is_open(moment(2026, month, day, utc_hour, 0))) << month << ' ' << day;
  }

  // An hour that is there twice is open twice; one that is not there is not.
  const OpeningHours night = hours_of("02:00-03:00", "Europe/Berlin");
  int minutes = 0;
  for (UtcTime now = moment(2026, 10, 24, 22, 0); now < moment(2026, 10, 25, 10, 0); now += 1min) {
    minutes += night.is_open(now) ? 1 : 0;
  }
  EXPECT_EQ(minutes, 120);
  for (UtcTime now = moment(2026, 3, 28, 23, 0); now < moment(2026, 3, 29, 10, 0); now += 1min) {
    EXPECT_FALSE(night.is_open(now));
  }
}

TEST(OpeningHours, EveryTimeThereIsHasAnAnswer) {
  const OpeningHours hours = hours_of("Mon-Fri 10:00-18:00", "Asia/Tokyo");
  for (const UtcTime now : {UtcTime{}, UtcTime{-1ns}, moment(1903, 1, 1, 0, 0), moment(2261, 12, 31, 23, 59)}) {
    EXPECT_THAT(hours.until_text(now), HasSubstr("until ")) << now.time_since_epoch().count();
  }
  EXPECT_TRUE(hours.is_open(moment(1970, 1, 1, 1, 0))) << "a Thursday, 10:00 in Tokyo";
}

TEST(OpeningHours, TheMachinesOwnZoneIsOneToo) {
  const auto hours = OpeningHours::parse("10:00-18:00", "");
  ASSERT_TRUE(hours.has_value());
  EXPECT_FALSE(hours->zone_name().empty());
  EXPECT_EQ(hours_of("10:00-18:00", "Europe/Berlin").zone_name(), "Europe/Berlin");
}

TEST(OpeningHours, SaysWhatIsNoSuchText) {
  for (const char* wrong : {"10-18",
                            "10:00",
                            "10:00-",
                            "-18:00",
                            "25:00-26:00",
                            "24:00-25:00",
                            "10:60-18:00",
                            "10:00-10:00",
                            "Tue",
                            "Foo 10:00-18:00",
                            "Mon-Foo 10:00-18:00",
                            "10:00-18:00,",
                            ",",
                            "10:00-18:00 Mon",
                            "10:00-18:00-20:00",
                            "Mon 10:00-18:00;Tue 10:00-18:00",
                            "10:00–18:00",
                            "+9:00-18:00",
                            "Mon,Tue 10:00-18:00",
                            "24:00-10:00"}) {
    const auto hours = OpeningHours::parse(wrong, "Etc/UTC");
    ASSERT_FALSE(hours.has_value()) << wrong;
    EXPECT_EQ(hours.error().name, "hours");
    EXPECT_THAT(hours.error().message, HasSubstr("allowed: FROM-TO")) << wrong;
  }
  std::string endless = "10:00-18:00";
  while (endless.size() < 6'000'000) endless += ",10:00-18:00";
  const auto refused = OpeningHours::parse(endless, "Etc/UTC");
  ASSERT_FALSE(refused.has_value());
  EXPECT_THAT(refused.error().message, HasSubstr("(maximum 1000)"));
  const auto zone = OpeningHours::parse("10:00-18:00", "Europe/Atlantis");
  ASSERT_FALSE(zone.has_value());
  EXPECT_EQ(zone.error().name, "zone");
  EXPECT_THAT(zone.error().message, HasSubstr("Europe/Atlantis"));
  for (const char* path : {"../../etc/passwd", "/etc/passwd", "posixrules/..", " "}) {
    EXPECT_FALSE(OpeningHours::parse("10:00-18:00", path).has_value()) << path;
  }
}

}  // namespace
}  // namespace yuragi::daemon::settings
