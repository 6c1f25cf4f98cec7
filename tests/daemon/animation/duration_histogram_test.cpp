#include "daemon/animation/duration_histogram.hpp"

#include <gtest/gtest.h>

namespace yuragi::daemon::animation {
namespace {

using std::chrono::hours;
using std::chrono::microseconds;

TEST(DurationHistogram, IsZeroWhileNothingWasCounted) {
  EXPECT_EQ(DurationHistogram().percentile_s(0.5), 0.0);
}

TEST(DurationHistogram, TellsPercentilesToWithinAnEighthAbove) {
  DurationHistogram histogram;
  for (int us = 1; us <= 10'000; ++us) histogram.add(microseconds(us));
  for (const double share : {0.01, 0.1, 0.5, 0.9, 0.99, 1.0}) {
    const double exact_s = share * 10'000e-6;
    EXPECT_GE(histogram.percentile_s(share), exact_s) << share;
    EXPECT_LE(histogram.percentile_s(share), exact_s * 1.125 + 1e-6) << share;
  }
}

TEST(DurationHistogram, TellsTheLongestExactly) {
  DurationHistogram histogram;
  EXPECT_EQ(histogram.max_s(), 0.0);
  histogram.add(microseconds(-5));
  EXPECT_EQ(histogram.max_s(), 0.0);
  for (const int us : {3, 1234, 5}) histogram.add(microseconds(us));
  EXPECT_EQ(histogram.max_s(), 1234e-6);
  histogram.add(hours(100'000));
  EXPECT_EQ(histogram.max_s(), 360e6);
}

TEST(DurationHistogram, TakesWhatIsNegativeAndWhatIsTooLong) {
  DurationHistogram histogram;
  histogram.add(microseconds(-5));
  EXPECT_LE(histogram.percentile_s(1.0), 1e-6);
  histogram.add(hours(100'000));
  EXPECT_GT(histogram.percentile_s(1.0), 3600.0);
}

}  // namespace
}  // namespace yuragi::daemon::animation
