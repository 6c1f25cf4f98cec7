#include "engine/math/critically_damped.hpp"

#include <cmath>
#include <limits>
#include <numbers>

#include <gtest/gtest.h>

namespace yuragi::math {
namespace {

TEST(CriticallyDamped, FollowsTheClosedFormOfAStep) {
  // From rest at 0 to a target of e: q(t) = e (1 - (1 + w t) exp(-w t)).
  constexpr double kTarget = 3.0;
  constexpr double kOmega = 2.0;
  CriticallyDamped follower;
  for (int step = 1; step <= 500; ++step) {
    follower.step(kTarget, kOmega, 0.01);
    const double phase = kOmega * 0.01 * step;
    EXPECT_NEAR(follower.value, kTarget * (1.0 - (1.0 + phase) * std::exp(-phase)), 1e-12);
    EXPECT_NEAR(follower.rate_per_s, kTarget * kOmega * phase * std::exp(-phase), 1e-12);
  }
}

TEST(CriticallyDamped, NeverOvershootsATargetAtRest) {
  CriticallyDamped follower;
  double previous = 0.0;
  for (int step = 0; step < 2000; ++step) {
    follower.step(1.0, 5.0, 0.01);
    EXPECT_GE(follower.value, previous);
    EXPECT_LE(follower.value, 1.0);
    previous = follower.value;
  }
  EXPECT_NEAR(follower.value, 1.0, 1e-12);
}

TEST(CriticallyDamped, MovesAStepAtMostByTheStepTimesOmegaOverE) {
  constexpr double kStep = 10.0;
  constexpr double kOmega = 0.7;
  constexpr double kDt = 1e-3;
  const double limit_per_s = kStep * kOmega / std::numbers::e;
  CriticallyDamped follower;
  double fastest_per_s = 0.0;
  for (int step = 0; step < 10000; ++step) {
    const double before = follower.value;
    follower.step(kStep, kOmega, kDt);
    fastest_per_s = std::max(fastest_per_s, (follower.value - before) / kDt);
  }
  EXPECT_LE(fastest_per_s, limit_per_s * (1.0 + 1e-12));
  EXPECT_GT(fastest_per_s, 0.999 * limit_per_s);
}

TEST(CriticallyDamped, ManySmallStepsEndWhereOneBigStepDoes) {
  CriticallyDamped many{4.0, -7.0};
  CriticallyDamped one = many;
  for (int step = 0; step < 1000; ++step) many.step(-2.0, 3.0, 0.0015);
  one.step(-2.0, 3.0, 1.5);
  EXPECT_NEAR(many.value, one.value, 1e-11);
  EXPECT_NEAR(many.rate_per_s, one.rate_per_s, 1e-11);
}

TEST(CriticallyDamped, KeepsValueAndRateWhenTheTargetJumps) {
  CriticallyDamped follower{1.0, 0.5};
  follower.step(1e6, 2.0, 1e-9);
  EXPECT_NEAR(follower.value, 1.0, 1e-8);
  EXPECT_NEAR(follower.rate_per_s, 0.5, 0.005);  // the acceleration is at most w^2 e
}

TEST(CriticallyDamped, ArrivesInOneStepHoweverLong) {
  for (const double dt_s : {1e3, 1e9, 1e50, 1e100}) {
    for (const double omega_rad_s : {1.0, 1e3, 1e100}) {
      CriticallyDamped follower{-1e100, 1e100};
      follower.step(2.5, omega_rad_s, dt_s);
      EXPECT_EQ(follower.value, 2.5);
      EXPECT_EQ(follower.rate_per_s, 0.0);
    }
  }
}

TEST(CriticallyDamped, IsFiniteForFiniteInput) {
  for (const double value : {-1e100, -1.0, 0.0, 1e100}) {
    for (const double omega_rad_s : {0.0, 1e-100, 1e-3, 1.0, 699.0, 1e100}) {
      for (const double dt_s : {1e-100, 1e-3, 1.0, 1e100}) {
        CriticallyDamped follower{value, -value};
        follower.step(-value, omega_rad_s, dt_s);
        EXPECT_TRUE(std::isfinite(follower.value) && std::isfinite(follower.rate_per_s))
            << value << ' ' << omega_rad_s << ' ' << dt_s;
      }
    }
  }
}

TEST(CriticallyDamped, WithoutATimeThatGoesOnNothingChanges) {
  for (const double dt_s : {0.0, -1.0, std::numeric_limits<double>::quiet_NaN()}) {
    CriticallyDamped follower{1.0, 2.0};
    follower.step(9.0, 3.0, dt_s);
    EXPECT_EQ(follower.value, 1.0);
    EXPECT_EQ(follower.rate_per_s, 2.0);
  }
}

TEST(CriticallyDamped, WithoutStiffnessItCoasts) {
  CriticallyDamped follower{1.0, 2.0};
  follower.step(9.0, 0.0, 3.0);
  EXPECT_DOUBLE_EQ(follower.value, 7.0);
  EXPECT_DOUBLE_EQ(follower.rate_per_s, 2.0);
}

}  // namespace
}  // namespace yuragi::math
