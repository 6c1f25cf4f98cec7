#include "engine/scenes/reading_schedule.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "engine/math/critically_damped.hpp"

namespace yuragi::scenes {
namespace {

constexpr double kScheduleTick_s = 1.0 / 60.0;

/// How often each part is read in these ticks.
std::vector<int> readings(ReadingSchedule& schedule, std::uint64_t first_tick, std::size_t steps,
                          std::uint64_t stride) {
  std::vector<int> counts;
  for (std::size_t i = 0; i < steps; ++i) {
    const ReadingSchedule::Due due =
        schedule.advance(first_tick + i * stride, static_cast<double>(stride) * kScheduleTick_s);
    counts.resize(due.parts);
    for (std::size_t k = 0; k < due.count; ++k) ++counts[(due.first + k) % due.parts];
  }
  return counts;
}

TEST(ReadingSchedule, ReadsAllAtFirstAndThenOnePartATick) {
  ReadingSchedule schedule;
  EXPECT_EQ(schedule.advance(1000, kScheduleTick_s).count, 5U);
  for (std::uint64_t tick = 1001; tick < 1100; ++tick) {
    const ReadingSchedule::Due due = schedule.advance(tick, kScheduleTick_s);
    EXPECT_EQ(due.parts, 5U);
    EXPECT_EQ(due.count, 1U);
    EXPECT_EQ(due.first, tick % 5) << "the part depends on the tick's number alone";
    EXPECT_DOUBLE_EQ(due.lead_s, 5.0 / 60.0);
  }
}

TEST(ReadingSchedule, EachPartIsReadTwelveTimesASecondAlsoIfTicksAreSkipped) {
  for (const std::uint64_t stride : {1U, 2U, 3U}) {
    ReadingSchedule schedule;
    schedule.advance(7, kScheduleTick_s);
    EXPECT_EQ(readings(schedule, 7 + stride, 300 / stride, stride), std::vector<int>(5, 60)) << stride;
  }
  ReadingSchedule schedule;
  schedule.advance(0, kScheduleTick_s);
  EXPECT_EQ(schedule.advance(100, 0.1).count, 5U) << "after a long pause all are read";
  EXPECT_EQ(schedule.advance(50, kScheduleTick_s).count, 5U) << "and when the numbers begin anew";
}

TEST(ReadingSchedule, WithoutANumberOrAtFewTicksASecondAllIsReadAtOnce) {
  ReadingSchedule schedule;
  for (const ReadingSchedule::Due& due : {schedule.advance({}, kScheduleTick_s), schedule.advance(3, 0.1)}) {
    EXPECT_EQ(due.parts, 1U);
    EXPECT_EQ(due.count, 1U);
    EXPECT_EQ(due.lead_s, 0.0);
    EXPECT_EQ(ReadingSchedule::matched_rate_rad_s(20.0, due), 20.0);
  }
  EXPECT_EQ(schedule.advance(4, 1.0 / 144.0).parts, 12U);
}

/// What a filter leaves of a wave, as a part of its height: read at each tick, or each due.parts ticks with straight
/// lines between.
double height_left(double frequency_hz, double rate_rad_s, std::uint64_t parts) {
  math::CriticallyDamped filter;
  double height = 0.0;
  const auto wave = [&](std::uint64_t tick) {
    return std::sin(2.0 * std::numbers::pi * frequency_hz * static_cast<double>(tick) * kScheduleTick_s);
  };
  for (std::uint64_t tick = 0; tick < 6000; ++tick) {
    const std::uint64_t from = tick / parts * parts;
    const double part = static_cast<double>(tick - from) / static_cast<double>(parts);
    filter.step((1.0 - part) * wave(from) + part * wave(from + parts), rate_rad_s, kScheduleTick_s);
    if (tick > 600) height = std::max(height, std::abs(filter.value));
  }
  return height;
}

TEST(ReadingSchedule, TheMatchedFilterLetsThroughWhatTheFilterOfEachTickDoes) {
  const ReadingSchedule::Due due{.parts = 5, .first = 0, .count = 1, .lead_s = 5.0 * kScheduleTick_s};
  const double matched_rad_s = ReadingSchedule::matched_rate_rad_s(20.0, due);
  for (const double frequency_hz : {0.1, 0.31, 0.53, 0.97, 1.43, 2.03}) {
    const double ratio = height_left(frequency_hz, matched_rad_s, 5) / height_left(frequency_hz, 20.0, 1);
    EXPECT_NEAR(20.0 * std::log10(ratio), 0.0, 0.22) << frequency_hz << " Hz";
  }
}

}  // namespace
}  // namespace yuragi::scenes
