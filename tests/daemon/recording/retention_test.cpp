#include "daemon/recording/retention.hpp"

#include <limits>

#include <gtest/gtest.h>

namespace yuragi::daemon::recording {
namespace {

using namespace std::chrono_literals;

const UtcTime kNoon = UtcTime(std::chrono::sys_days(std::chrono::year(2026) / 11 / 23)) + 12h;

TEST(Retention, AFileIsCompleteOnAnotherDayOrWhenItIsLarge) {
  settings::RecordingConfig rules;
  EXPECT_FALSE(is_complete(rules, kNoon, 1'000'000'000, kNoon + 1000h)) << "unless it is told so, never";
  rules.is_daily = true;
  EXPECT_FALSE(is_complete(rules, kNoon, 0, kNoon + 12h - 1ns));
  EXPECT_TRUE(is_complete(rules, kNoon, 0, kNoon + 12h));
  EXPECT_FALSE(is_complete(rules, kNoon, 0, kNoon - 1h)) << "a small step back, at midnight perhaps";
  EXPECT_TRUE(is_complete(rules, kNoon, 0, kNoon - 1h - 1ns)) << "the clock was set back";
  rules = {.most_file_bytes = 1000};
  EXPECT_FALSE(is_complete(rules, kNoon, 1000, kNoon));
  EXPECT_TRUE(is_complete(rules, kNoon, 1001, kNoon));
}

/// Parts of 100 bytes, one a day, the last one yesterday's.
std::vector<KeptPart> parts_of_days(int days) {
  std::vector<KeptPart> parts;
  for (int day = days; day >= 1; --day) {
    parts.push_back({.file = std::to_string(day), .begin = kNoon - day * 24h, .bytes = 100});
  }
  return parts;
}

std::size_t count_deleted(const settings::RecordingConfig& rules, std::uint64_t written_bytes = 0,
                          std::uint64_t free_bytes = 0, std::size_t max_by_age = 10) {
  const auto deleted = parts_to_delete(rules, parts_of_days(10), written_bytes, free_bytes, kNoon, max_by_age);
  for (std::size_t i = 0; i < deleted.size(); ++i) EXPECT_EQ(deleted[i].file, std::to_string(10 - i)) << "oldest first";
  return deleted.size();
}

TEST(Retention, TheOldestGoUntilAllRulesHold) {
  EXPECT_EQ(count_deleted({}), 0U);
  EXPECT_EQ(count_deleted({.keep_days = 30}), 0U);
  EXPECT_EQ(count_deleted({.keep_days = 7}), 2U) << "each ended when the next began";
  EXPECT_EQ(count_deleted({.most_bytes = 1000}, 0), 0U);
  EXPECT_EQ(count_deleted({.most_bytes = 1000}, 1), 1U) << "the one that is written counts";
  EXPECT_EQ(count_deleted({.most_bytes = 450}, 0), 6U);
  EXPECT_EQ(count_deleted({.most_bytes = 1}, 5000), 10U) << "but it is never deleted";
  EXPECT_EQ(count_deleted({.least_free_bytes = 250}, 0, 250), 0U);
  EXPECT_EQ(count_deleted({.least_free_bytes = 250}, 0, 249), 1U);
  EXPECT_EQ(count_deleted({.least_free_bytes = 250}, 0, 0), 3U);
  EXPECT_EQ(count_deleted({.keep_days = 7, .most_bytes = 450, .least_free_bytes = 10}, 0, 0), 6U);
}

TEST(Retention, AgeDeletesNoMoreThanItMayAndSpaceWhatItMust) {
  EXPECT_EQ(count_deleted({.keep_days = 2}), 7U);
  EXPECT_EQ(count_deleted({.keep_days = 2}, 0, 0, 2), 2U);
  EXPECT_EQ(count_deleted({.keep_days = 2}, 0, 0, 0), 0U);
  EXPECT_EQ(count_deleted({.keep_days = 2, .most_bytes = 450}, 0, 0, 0), 6U);
  EXPECT_EQ(count_deleted({.keep_days = 2, .most_bytes = 650}, 0, 0, 2), 6U) << "four by space, two by age";
  const auto deleted = parts_to_delete({.keep_days = 2, .least_free_bytes = 150}, parts_of_days(10), 0, 0, kNoon, 1);
  ASSERT_EQ(deleted.size(), 3U);
  EXPECT_FALSE(deleted[0].is_by_age);
  EXPECT_FALSE(deleted[1].is_by_age);
  EXPECT_TRUE(deleted[2].is_by_age);
}

TEST(Retention, TheLimitsHoldUntilTheNextLookToo) {
  const settings::RecordingConfig tight =
      with_room_to_grow({.keep_days = 7, .most_bytes = 100'000'000, .least_free_bytes = 500'000'000});
  EXPECT_EQ(tight.keep_days, 7);
  EXPECT_EQ(tight.most_bytes, 92'000'000U);
  EXPECT_EQ(tight.least_free_bytes, 508'000'000U);
  EXPECT_EQ(with_room_to_grow({.most_bytes = 4'000'000}).most_bytes, 3'000'000U);
  const std::uint64_t everything = std::numeric_limits<std::uint64_t>::max();
  EXPECT_EQ(with_room_to_grow({.least_free_bytes = everything}).least_free_bytes, everything);
  const settings::RecordingConfig none = with_room_to_grow({});
  EXPECT_EQ(none.most_bytes, 0U) << "no limit stays none";
  EXPECT_EQ(none.least_free_bytes, 0U);
}

}  // namespace
}  // namespace yuragi::daemon::recording
