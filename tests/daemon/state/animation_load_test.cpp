#include "daemon/state/animation_load.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace yuragi::daemon::state {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

TEST(AnimationLoad, IsWhatFitsIntoHalfOfEachTick) {
  const wire::AnimationStatus animation{
      .running_s = 9.0, .period_s = 0.016, .tick_s = 0.002, .scenes = {{"ground", 0.0015}}};
  EXPECT_DOUBLE_EQ(carried_times(animation).value(), 4.0);
  EXPECT_DOUBLE_EQ(share_of(animation.scenes[0], animation), 0.75);
  EXPECT_EQ(animation_text(animation), "2.00 ms of work in each 16.00 ms; this machine carries 4.0 times as much");
}

TEST(AnimationLoad, SaysWhereItIsTooMuch) {
  EXPECT_THAT(animation_text({.period_s = 0.016, .tick_s = 0.009}), HasSubstr("fewer or smaller scenes"));
}

TEST(AnimationLoad, IsNotKnownBeforeTheFirstTick) {
  const wire::AnimationStatus animation{.period_s = 0.016, .scenes = {{"ground", 0.0}}};
  EXPECT_EQ(carried_times(animation), std::nullopt);
  EXPECT_EQ(share_of(animation.scenes[0], animation), 0.0);
  EXPECT_THAT(animation_text(animation), Not(HasSubstr("machine")));
}

}  // namespace
}  // namespace yuragi::daemon::state
