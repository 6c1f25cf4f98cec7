#include "daemon/stream/log_allowance.hpp"

#include <gtest/gtest.h>

namespace yuragi::daemon::stream {
namespace {

using namespace std::chrono_literals;

class LogAllowanceTest : public testing::Test {
 protected:
  static MonoTime at(Nanoseconds time) { return MonoTime(time); }

  /// How many of `count` lines at once are allowed.
  int allowed(int count, Nanoseconds now) {
    int lines = 0;
    for (int i = 0; i < count; ++i) lines += allowance_.take(at(now)) ? 1 : 0;
    return lines;
  }

  LogAllowance allowance_{{.burst = 20.0, .per_s = 2.0, .report_every = 10s}, at(0s)};
};

TEST_F(LogAllowanceTest, SoManyAtOnceAndThenSoManyASecond) {
  EXPECT_EQ(allowed(1000, 0s), 20);
  EXPECT_EQ(allowed(1000, 499ms), 0);
  EXPECT_EQ(allowed(1000, 500ms), 1);
  EXPECT_EQ(allowed(1000, 3500ms), 6);
}

TEST_F(LogAllowanceTest, ALongSilenceSavesNoMoreThanOneBurst) {
  allowed(20, 0s);
  EXPECT_EQ(allowed(1000, 24h), 20);
}

TEST_F(LogAllowanceTest, AFloodOfAnHourIsBounded) {
  int lines = 0;
  for (int second = 0; second < 3600; ++second) lines += allowed(2300, std::chrono::seconds(second));
  EXPECT_EQ(lines, 20 + 2 * 3599);
}

TEST_F(LogAllowanceTest, WhatWasLeftOutIsToldOnce) {
  allowed(1020, 1s);
  EXPECT_EQ(allowance_.take_left_out(at(9s)), 0U) << "the flood may go on";
  EXPECT_EQ(allowance_.take_left_out(at(10s)), 1000U);
  EXPECT_EQ(allowance_.take_left_out(at(30s)), 0U);
}

TEST_F(LogAllowanceTest, AFloodThatGoesOnIsToldAgainAfterItsTime) {
  allowed(120, 0s);
  EXPECT_EQ(allowance_.take_left_out(at(10s)), 100U);
  EXPECT_EQ(allowed(120, 10s), 20);
  EXPECT_EQ(allowance_.take_left_out(at(19s)), 0U);
  EXPECT_EQ(allowance_.take_left_out(at(20s)), 100U);
}

TEST_F(LogAllowanceTest, NothingLeftOutIsNotTold) {
  allowed(20, 0s);
  EXPECT_EQ(allowance_.take_left_out(at(1h)), 0U);
}

}  // namespace
}  // namespace yuragi::daemon::stream
