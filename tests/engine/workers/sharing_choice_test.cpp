#include "engine/workers/sharing_choice.hpp"

#include <gtest/gtest.h>

namespace yuragi::workers {
namespace {

using namespace std::chrono_literals;

/// How many of so many ticks are shared, and the mean of all, s.
struct Ticks {
  int shared = 0;
  double mean_s = 0.0;
};

Ticks run(SharingChoice& choice, int count, Nanoseconds alone, Nanoseconds shared) {
  Ticks ticks;
  for (int i = 0; i < count; ++i) {
    const Nanoseconds duration = choice.is_shared() ? shared : alone;
    if (choice.is_shared()) ++ticks.shared;
    ticks.mean_s += seconds(duration) / count;
    choice.took(duration);
  }
  return ticks;
}

TEST(SharingChoiceTest, SharesAtOnceWhereThatIsFaster) {
  SharingChoice choice;
  const Ticks ticks = run(choice, 60, 2ms, 1ms);
  EXPECT_EQ(ticks.shared, 60 - SharingChoice::kTrialTicks);
}

TEST(SharingChoiceTest, IsAloneWhereOthersHoldItUpButForATrialNowAndThen) {
  SharingChoice choice;
  run(choice, 60, 2ms, 3ms);
  const Ticks ticks = run(choice, 100 * SharingChoice::kCycleTicks, 2ms, 3ms);
  EXPECT_EQ(ticks.shared, 100 * SharingChoice::kTrialTicks);
  EXPECT_LT(ticks.mean_s, 1.005 * 0.002);
}

TEST(SharingChoiceTest, FollowsTheMachineWithinACycle) {
  SharingChoice choice;
  run(choice, 3000, 2ms, 1ms);
  run(choice, SharingChoice::kCycleTicks, 2ms, 6ms);  // another program has come
  EXPECT_FALSE(choice.is_shared());
  run(choice, SharingChoice::kCycleTicks, 2ms, 1ms);  // and gone
  EXPECT_TRUE(choice.is_shared());
}

TEST(SharingChoiceTest, NeitherIsPreferredWhereBothTakeAsLong) {
  SharingChoice choice;
  run(choice, 10 * SharingChoice::kCycleTicks, 2ms, 2ms);
  EXPECT_FALSE(choice.is_shared()) << "as it was";
}

}  // namespace
}  // namespace yuragi::workers
