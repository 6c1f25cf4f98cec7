#include "engine/math/trig.hpp"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

namespace yuragi::math {
namespace {

TEST(SinCosTest, IsWithin15e8OfTheTruthUpTo50Radians) {
  double largest_error = 0.0;
  const int steps = 2'000'000;
  for (int i = -steps; i <= steps; ++i) {
    const float angle = 50.0F * static_cast<float>(i) / static_cast<float>(steps);
    const SinCos result = sin_cos(angle);
    const auto exact = static_cast<double>(angle);
    largest_error = std::max(largest_error, std::abs(static_cast<double>(result.sin) - std::sin(exact)));
    largest_error = std::max(largest_error, std::abs(static_cast<double>(result.cos) - std::cos(exact)));
  }
  EXPECT_LT(largest_error, 1.5e-7);
}

TEST(SinCosTest, OfZeroIsExact) {
  for (const float zero : {0.0F, -0.0F}) {
    EXPECT_EQ(sin_cos(zero).sin, 0.0F);
    EXPECT_EQ(sin_cos(zero).cos, 1.0F);
  }
}

TEST(SinCosTest, KeepsTinyAngles) {
  const float tiny = 1e-30F;
  EXPECT_EQ(sin_cos(tiny).sin, tiny);
  EXPECT_EQ(sin_cos(-tiny).sin, -tiny);
}

TEST(SinCosTest, HasTheSymmetriesOfSineAndCosine) {
  for (int i = 0; i < 5000; ++i) {
    const float angle = 0.01F * static_cast<float>(i);
    EXPECT_EQ(sin_cos(-angle).sin, -sin_cos(angle).sin) << angle;
    EXPECT_EQ(sin_cos(-angle).cos, sin_cos(angle).cos) << angle;
  }
}

}  // namespace
}  // namespace yuragi::math
