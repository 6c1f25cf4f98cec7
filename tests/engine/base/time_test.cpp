#include "engine/base/time.hpp"

#include <gtest/gtest.h>

namespace yuragi {
namespace {

using namespace std::chrono_literals;

TEST(Time, SecondsAndNanosecondsAreTheSameDuration) {
  EXPECT_DOUBLE_EQ(seconds(1500ms), 1.5);
  EXPECT_DOUBLE_EQ(seconds(-1ns), -1e-9);
  EXPECT_EQ(from_seconds(1.5), 1500ms);
  EXPECT_EQ(from_seconds(-0.25), -250ms);
  EXPECT_EQ(from_seconds(0.0), 0ns);
}

TEST(Time, ThereAndBackKeepsEveryNanosecondOfADay) {
  for (const Nanoseconds duration : {Nanoseconds(1), Nanoseconds(16666667), Nanoseconds(24h) + 1ms}) {
    EXPECT_NEAR(static_cast<double>((from_seconds(seconds(duration)) - duration).count()), 0.0, 1.0);
  }
}

TEST(Time, AnInstantStartsAtZeroOnBothTimeLines) {
  const Instant instant;
  EXPECT_EQ(instant.mono.time_since_epoch(), 0ns);
  EXPECT_EQ(instant.utc.time_since_epoch(), 0ns);
}

}  // namespace
}  // namespace yuragi
