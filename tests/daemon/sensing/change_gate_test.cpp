#include "daemon/sensing/change_gate.hpp"

#include <gtest/gtest.h>

namespace yuragi::daemon::sensing {
namespace {

MonoTime gate_time(double time_s) {
  return MonoTime(from_seconds(1000.0 + time_s));
}

TEST(ChangeGate, WhatIsSoFromTheBeginningIsNotToldAndTheFirstChangeAtOnce) {
  ChangeGate gate(0);
  EXPECT_FALSE(gate.offer(0, gate_time(0.0)));
  EXPECT_TRUE(gate.offer(1, gate_time(0.1)));
  EXPECT_FALSE(gate.offer(1, gate_time(0.2))) << "once";
  EXPECT_EQ(gate.reported(), 1U);
}

TEST(ChangeGate, AChangeThatDoesNotLastIsCountedAndNotTold) {
  ChangeGate gate(0);
  gate.offer(1, gate_time(0.0));
  EXPECT_FALSE(gate.offer(2, gate_time(1.0)));
  EXPECT_FALSE(gate.offer(1, gate_time(1.5))) << "as it was told";
  EXPECT_FALSE(gate.offer(3, gate_time(5.0)));
  EXPECT_TRUE(gate.offer(3, gate_time(6.5)));
  EXPECT_EQ(gate.passed_over(), 1U) << "the 2 was never told";
  EXPECT_EQ(gate.reported(), 3U);
}

TEST(ChangeGate, AMonthOfFlappingIsReadableAndCountedInFull) {
  for (const double period_s : {0.5, 7.0, 45.0, 400.0}) {
    ChangeGate gate(0);
    int reported = 0;
    std::uint64_t passed_over = 0;
    std::uint64_t changes = 0;
    std::uint32_t value = 0;
    const double step_s = period_s / 4.0;
    const double month_s = 30.0 * 86400.0;
    double next_change_s = 0.0;
    for (double now_s = 0.0; now_s < month_s; now_s += step_s) {
      if (now_s >= next_change_s) {
        value = 1 - value;
        ++changes;
        next_change_s = now_s + period_s;
      }
      if (!gate.offer(value, gate_time(now_s))) continue;
      ++reported;
      passed_over += gate.passed_over();
    }
    EXPECT_LT(reported, 30 * 24 * 6) << period_s << " s: more than six lines an hour";
    EXPECT_GT(reported, 30) << period_s << " s: that it flaps is told again and again";
    EXPECT_LE(passed_over, changes);
  }
}

TEST(ChangeGate, AChangeAfterAQuietDayIsToldWithinASecondOrTwo) {
  ChangeGate gate(0);
  for (int i = 0; i < 100000; ++i) gate.offer(static_cast<std::uint32_t>(i / 2 % 2), gate_time(i));
  gate.offer(0, gate_time(100'001.0));
  gate.offer(0, gate_time(101'000.0));
  ASSERT_EQ(gate.reported(), 0U);
  gate.offer(1, gate_time(190'000.0));
  EXPECT_TRUE(gate.offer(1, gate_time(190'002.0)));
}

TEST(ChangeGate, AClockThatGoesBackTellsNothingTwice) {
  ChangeGate gate(0);
  EXPECT_TRUE(gate.offer(1, gate_time(0.0)));
  EXPECT_FALSE(gate.offer(1, gate_time(-500.0)));
  EXPECT_FALSE(gate.offer(2, gate_time(-500.0)));
  EXPECT_TRUE(gate.offer(2, gate_time(10.0)));
}

}  // namespace
}  // namespace yuragi::daemon::sensing
