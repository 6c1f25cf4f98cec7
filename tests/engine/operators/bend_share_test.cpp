#include "engine/operators/bend_share.hpp"

#include <algorithm>

#include <gtest/gtest.h>

namespace yuragi::operators {
namespace {

TEST(BendShareTest, IsHalfAtTheHalfBendSpeedAndNeverAboveOne) {
  EXPECT_EQ(bend_share(0.0F), 0.0F);
  EXPECT_EQ(bend_share(1.0F), 0.5F);
  EXPECT_EQ(bend_share(1e18F), 1.0F);
}

TEST(BendShareTest, AStrongerWindNeverBendsLess) {
  float before = 0.0F;
  for (float s_square = 0.0F; s_square < 1e6F; s_square = s_square * 1.001F + 1e-6F) {
    const float now = bend_share(s_square);
    ASSERT_GE(now, before) << s_square;
    before = now;
  }
}

TEST(BendShareTest, OverSItIsTheSameShareOverTheSpeed) {
  EXPECT_EQ(bend_share_over_s(0.0F, 0.0F), 0.0F);
  for (float s = 0.01F; s < 100.0F; s *= 1.1F) {
    EXPECT_NEAR(bend_share_over_s(s, s * s) * s, bend_share(s * s), 2e-7F) << s;
  }
}

TEST(BendShareTest, IsNowhereSteeperThanItSays) {
  float steepest = 0.0F;
  for (int step = 0; step < 1000; ++step) {
    const float s = 0.005F * static_cast<float>(step);
    const float next = s + 0.005F;
    steepest = std::max(steepest, (bend_share(next * next) - bend_share(s * s)) / 0.005F);
  }
  EXPECT_NEAR(steepest, kSteepestBendShare, 1e-4);
}

}  // namespace
}  // namespace yuragi::operators
