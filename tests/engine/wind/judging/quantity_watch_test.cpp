#include "engine/wind/judging/quantity_watch.hpp"

#include <random>

#include <gtest/gtest.h>

namespace yuragi::wind::judging {
namespace {

/// A sensor that sends readings at a fixed interval.
class Sender {
 public:
  explicit Sender(QuantityWatch& watch, double interval_s = 1.0) : watch_(watch), interval_s_(interval_s) {}

  void send(int readings, bool has_it, double speed_m_s = 5.0) {
    for (int i = 0; i < readings; ++i) {
      now_ += from_seconds(interval_s_);
      watch_.take(now_, speed_m_s, has_it);
    }
  }
  /// How long until the quantity is missing, s.
  double patience_s(double speed_m_s = 5.0) {
    double waited_s = 0.0;
    for (; !watch_.is_missing() && waited_s < 1e6; waited_s += interval_s_) send(1, false, speed_m_s);
    return waited_s;
  }

 private:
  QuantityWatch& watch_;
  double interval_s_;
  MonoTime now_{std::chrono::hours(1)};
};

TEST(QuantityWatch, WhatHasNeverComeAndIsNotPromisedIsNotMissed) {
  QuantityWatch watch;
  Sender(watch).send(10'000, false);
  EXPECT_FALSE(watch.is_expected());
  EXPECT_FALSE(watch.is_missing());
}

TEST(QuantityWatch, WhatIsPromisedIsMissedAfterAMinute) {
  QuantityWatch watch(true);
  Sender sender(watch);
  EXPECT_NEAR(sender.patience_s(), 61.0, 1.0);
  EXPECT_EQ(watch.last(), std::nullopt);
  sender.send(1, true);
  EXPECT_FALSE(watch.is_missing());
}

TEST(QuantityWatch, AVaneThatFallsSilentIsMissedAfterAMinuteOrFiveReadings) {
  QuantityWatch fast;
  Sender ten_a_second(fast, 0.1);
  ten_a_second.send(100, true);
  EXPECT_NEAR(ten_a_second.patience_s(), 60.0, 0.2);

  QuantityWatch slow;
  Sender every_minute(slow, 60.0);
  every_minute.send(100, true);
  EXPECT_NEAR(every_minute.patience_s(), 300.0, 1.0);
}

TEST(QuantityWatch, ACalmIsNoFault) {
  QuantityWatch watch;
  Sender sender(watch);
  sender.send(100, true);
  sender.send(100'000, false, 0.3);
  EXPECT_FALSE(watch.is_missing());
  EXPECT_NEAR(sender.patience_s(), 60.0, 1.0) << "from then on in wind";
}

TEST(QuantityWatch, WhatComesRarelyIsMissedLater) {
  // A station that sends its direction once in 20 readings on the average, at random.
  QuantityWatch watch;
  Sender sender(watch);
  std::mt19937 random(1);
  std::bernoulli_distribution comes(0.05);
  int alarms = 0;
  for (int reading = 0; reading < 100'000; ++reading) {
    const bool was_missing = watch.is_missing();
    sender.send(1, comes(random));
    if (reading > 1000 && watch.is_missing() && !was_missing) ++alarms;
  }
  EXPECT_LE(alarms, 1);
  EXPECT_LT(sender.patience_s(), 900.0) << "and all the same, where it does not come any more";
}

TEST(QuantityWatch, AFaultOfHoursIsNotUsualFromThenOn) {
  QuantityWatch watch;
  Sender sender(watch);
  sender.send(100, true);
  sender.send(4 * 3600, false);
  EXPECT_TRUE(watch.is_missing());
  sender.send(60, true);
  EXPECT_LT(sender.patience_s(), 70.0);
}

}  // namespace
}  // namespace yuragi::wind::judging
