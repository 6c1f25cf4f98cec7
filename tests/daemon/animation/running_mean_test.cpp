#include "daemon/animation/running_mean.hpp"

#include <cmath>

#include <gtest/gtest.h>

namespace yuragi::daemon::animation {
namespace {

using namespace std::chrono_literals;

TEST(RunningMeanTest, IsThePlainMeanAtFirst) {
  RunningMean mean;
  EXPECT_EQ(mean.mean_s(), 0.0);
  mean.add(1ms);
  EXPECT_DOUBLE_EQ(mean.mean_s(), 0.001);
  mean.add(3ms);
  EXPECT_DOUBLE_EQ(mean.mean_s(), 0.002);
}

TEST(RunningMeanTest, FollowsWhatChangesWithinItsMemory) {
  RunningMean mean;
  for (int i = 0; i < 1'000'000; ++i) mean.add(1ms);
  for (std::uint32_t i = 0; i < RunningMean::kMemoryTicks; ++i) mean.add(2ms);
  EXPECT_NEAR(mean.mean_s(), 0.001 + 0.001 * (1.0 - std::exp(-1.0)), 1e-6);
}

TEST(RunningMeanTest, ForgetsWhenItIsCleared) {
  RunningMean mean;
  for (int i = 0; i < 1000; ++i) mean.add(9ms);
  mean.clear();
  EXPECT_EQ(mean.mean_s(), 0.0);
  mean.add(1ms);
  EXPECT_DOUBLE_EQ(mean.mean_s(), 0.001);
}

}  // namespace
}  // namespace yuragi::daemon::animation
