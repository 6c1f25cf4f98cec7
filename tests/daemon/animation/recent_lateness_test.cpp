#include "daemon/animation/recent_lateness.hpp"

#include <gtest/gtest.h>

#include "daemon/animation/animation_loop.hpp"

namespace yuragi::daemon::animation {
namespace {

using namespace std::chrono_literals;

constexpr Nanoseconds kPeriod = 16'666'667ns;

TEST(LoopCounters, SkippedTicksCountAsLate) {
  LoopCounters counters;
  TickSchedule schedule(MonoTime{}, 60.0);
  counters.add(schedule.begin_tick(MonoTime{1ms}), schedule.period());
  counters.add(schedule.begin_tick(MonoTime{1ms + 5 * schedule.period()}), schedule.period());  // skips four
  EXPECT_EQ(counters.ticks, 2U);
  EXPECT_EQ(counters.skipped_ticks, 4U);
  EXPECT_LT(counters.lateness.percentile_s(2.0 / 6.0), 2e-3);
  EXPECT_GT(counters.lateness.percentile_s(3.0 / 6.0), seconds(schedule.period()));
  EXPECT_NEAR(counters.lateness.max_s(), 1e-3 + 4.0 * seconds(schedule.period()), 1e-9);
}

/// A minute of 60 ticks a second, `skipped` of them late by a period and more.
void pass_minute(DurationHistogram& all, std::uint64_t skipped) {
  all.add(100us, 3600 - skipped);
  all.add(kPeriod + 100us, skipped);
}

TEST(RecentLateness, IsOfTheTimeSinceTheBeginningAtFirst) {
  DurationHistogram all;
  RecentLateness recent(all);
  recent.advance(MonoTime{1h});
  EXPECT_EQ(recent.count(), 0U);
  EXPECT_EQ(recent.percentile_s(0.99), 0.0);
  for (int minute = 1; minute < 9; ++minute) {
    pass_minute(all, 0);
    recent.advance(MonoTime{1h + minute * 1min});
    EXPECT_EQ(recent.count(), 3600U * static_cast<unsigned>(minute));
  }
}

TEST(RecentLateness, ForgetsWhatWasTenMinutesAgo) {
  DurationHistogram all;
  RecentLateness recent(all);
  MonoTime now{1h};
  const auto pass = [&](std::uint64_t skipped) {
    pass_minute(all, skipped);
    now += 1min;
    recent.advance(now);
  };
  recent.advance(now);
  for (int minute = 0; minute < 24 * 60; ++minute) pass(0);
  EXPECT_LT(recent.percentile_s(0.99), 1e-3);
  for (int minute = 0; minute < 2; ++minute) pass(1800);  // a program that takes the processor for two minutes
  EXPECT_GT(recent.percentile_s(0.99), seconds(kPeriod));
  EXPECT_GE(recent.max_s(), seconds(kPeriod));
  for (int minute = 0; minute < 7; ++minute) pass(0);
  EXPECT_GT(recent.percentile_s(0.99), seconds(kPeriod)) << "9 minutes later";
  for (int minute = 0; minute < 3; ++minute) pass(0);
  EXPECT_LT(recent.percentile_s(0.99), 1e-3);
  EXPECT_LT(recent.max_s(), 1e-3) << "the longest of these minutes, not of all";
  EXPECT_GE(recent.count(), 9U * 3600U);
  EXPECT_LE(recent.count(), 10U * 3600U);
}

TEST(RecentLateness, TheWindowIsNoLongerWhereItIsLookedAtOften) {
  DurationHistogram all;
  RecentLateness recent(all);
  for (int half_second = 0; half_second < 3600; ++half_second) {
    recent.advance(MonoTime{1h + half_second * 500ms});
    all.add(1us);
  }
  EXPECT_GE(recent.count(), 9U * 120U - 1U);
  EXPECT_LE(recent.count(), 10U * 120U);
}

}  // namespace
}  // namespace yuragi::daemon::animation
