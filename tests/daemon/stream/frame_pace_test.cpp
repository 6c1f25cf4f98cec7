#include "daemon/stream/frame_pace.hpp"

#include <gtest/gtest.h>

namespace yuragi::daemon::stream {
namespace {

using namespace std::chrono_literals;

constexpr Nanoseconds kSecond = 1s;

/// How many of the frames that come 60 times a second, from `begin` to `end`, are taken.
int taken(FramePace& pace, Nanoseconds begin, Nanoseconds end) {
  int count = 0;
  for (int i = 0; begin + i * kSecond / 60 < end; ++i) count += pace.take(MonoTime(begin + i * kSecond / 60)) ? 1 : 0;
  return count;
}

TEST(FramePace, TheRateHoldsAlsoWhereItDoesNotDivideThatOfTheFrames) {
  for (const double rate_hz : {0.5, 7.0, 12.5, 25.0, 30.0, 45.0, 60.0}) {
    FramePace pace(rate_hz, MonoTime(0s));
    EXPECT_NEAR(taken(pace, 0s, 100s), 100.0 * rate_hz, 2.0) << rate_hz;
  }
}

TEST(FramePace, AHigherRateThanThatOfTheFramesTakesThemAll) {
  FramePace pace(1000.0, MonoTime(0s));
  EXPECT_EQ(taken(pace, 0s, 10s), 600);
}

TEST(FramePace, AfterAPauseOnlyOneFrameIsMadeUpFor) {
  FramePace pace(10.0, MonoTime(0s));
  taken(pace, 0s, 1s);
  EXPECT_LE(taken(pace, 60s, 61s), 11 + 1);
}

TEST(FramePace, ARateOfNextToNothingIsOneFrameAnHour) {
  FramePace pace(1e-300, MonoTime(0s));
  EXPECT_TRUE(pace.take(MonoTime(0s)));
  EXPECT_FALSE(pace.take(MonoTime(3599s)));
  EXPECT_TRUE(pace.take(MonoTime(3600s)));
}

}  // namespace
}  // namespace yuragi::daemon::stream
