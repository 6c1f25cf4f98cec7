#include "daemon/settings/local_clock.hpp"

#include <gtest/gtest.h>

namespace yuragi::daemon::settings {
namespace {

using namespace std::chrono_literals;

UtcTime utc_at(int year, unsigned month, unsigned day, std::chrono::seconds of_day) {
  return std::chrono::sys_days(std::chrono::year(year) / std::chrono::month(month) / std::chrono::day(day)) + of_day;
}

TEST(LocalClock, IsUtcWithoutAZone) {
  EXPECT_EQ(LocalClock().hour_of_day(utc_at(2026, 11, 23, 6h + 30min)), 6.5);
  EXPECT_EQ(LocalClock().hour_of_day(utc_at(1969, 12, 31, 23h)), 23.0) << "before 1970, too";
  EXPECT_EQ(LocalClock().zone_name(), "UTC");
}

TEST(LocalClock, GoesOverMidnight) {
  const LocalClock tokyo = *LocalClock::of_zone("Asia/Tokyo");  // 9 hours ahead
  EXPECT_NEAR(tokyo.hour_of_day(utc_at(2026, 11, 23, 15h - 1s)), 24.0, 0.001);
  EXPECT_LT(tokyo.hour_of_day(utc_at(2026, 11, 23, 15h - 1s)), 24.0);
  EXPECT_EQ(tokyo.hour_of_day(utc_at(2026, 11, 23, 15h)), 0.0);
}

TEST(LocalClock, FollowsDaylightSavingTime) {
  const LocalClock berlin = *LocalClock::of_zone("Europe/Berlin");
  EXPECT_EQ(berlin.hour_of_day(utc_at(2026, 1, 15, 12h)), 13.0);
  EXPECT_EQ(berlin.hour_of_day(utc_at(2026, 7, 15, 12h)), 14.0);
  // In the night to 29 March the clocks go from 2 to 3, and in the night to 25 October from 3 to 2.
  EXPECT_NEAR(berlin.hour_of_day(utc_at(2026, 3, 29, 1h - 1s)), 2.0, 0.001);
  EXPECT_EQ(berlin.hour_of_day(utc_at(2026, 3, 29, 1h)), 3.0);
  EXPECT_NEAR(berlin.hour_of_day(utc_at(2026, 10, 25, 1h - 1s)), 3.0, 0.001);
  EXPECT_EQ(berlin.hour_of_day(utc_at(2026, 10, 25, 1h)), 2.0);
}

TEST(LocalClock, RefusesAZoneThatIsNotKnown) {
  EXPECT_EQ(LocalClock::of_zone("Europe/Nowhere").error().name, "zone");
  EXPECT_TRUE(LocalClock::of_zone("")) << "this machine's own";
}

}  // namespace
}  // namespace yuragi::daemon::settings
