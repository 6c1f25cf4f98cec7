#include "daemon/animation/tick_schedule.hpp"

#include <gtest/gtest.h>

namespace yuragi::daemon::animation {
namespace {

using std::chrono::milliseconds;

const MonoTime kBegin{std::chrono::seconds(100)};

TEST(TickSchedule, DeadlinesStandOnAFixedGridHoweverLateEachTickBegins) {
  TickSchedule schedule(kBegin, 100.0);
  for (std::uint64_t number = 0; number < 1000; ++number) {
    const MonoTime deadline = kBegin + number * milliseconds(10);
    ASSERT_EQ(schedule.next_deadline(), deadline);
    const Nanoseconds late = milliseconds(static_cast<int>(number % 10));
    const TickSchedule::Tick tick = schedule.begin_tick(deadline + late);
    ASSERT_EQ(tick.number, number);
    ASSERT_EQ(tick.skipped, 0U);
    ASSERT_EQ(tick.lateness, late);
  }
}

TEST(TickSchedule, SkipsAndCountsWhatHasPassedAndNeverRunsAfterIt) {
  TickSchedule schedule(kBegin, 100.0);
  schedule.begin_tick(kBegin);
  // Due at 10 ms, begun at 57 ms: the moments 10, 20, 30, 40 are lost, and this is the tick of 50 ms.
  const TickSchedule::Tick tick = schedule.begin_tick(kBegin + milliseconds(57));
  EXPECT_EQ(tick.number, 5U);
  EXPECT_EQ(tick.skipped, 4U);
  EXPECT_EQ(tick.lateness, milliseconds(7));
  EXPECT_EQ(schedule.next_deadline(), kBegin + milliseconds(60)) << "the next one is ahead, not behind";
}

TEST(TickSchedule, AHaltOfADayCostsOneTick) {
  TickSchedule schedule(kBegin, 60.0);
  schedule.begin_tick(kBegin);
  const MonoTime morning = kBegin + std::chrono::hours(24);
  const TickSchedule::Tick tick = schedule.begin_tick(morning);
  EXPECT_GT(tick.skipped, 5'000'000U);
  EXPECT_LT(tick.lateness, schedule.period());
  EXPECT_GT(schedule.next_deadline(), morning);
}

}  // namespace
}  // namespace yuragi::daemon::animation
