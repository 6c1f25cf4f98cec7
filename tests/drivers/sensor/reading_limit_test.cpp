#include "drivers/sensor/reading_limit.hpp"

#include <gtest/gtest.h>

namespace yuragi::drivers::sensor {
namespace {

using namespace std::chrono_literals;

/// How many of the readings that come this often are admitted in ten seconds.
int admitted_in_10_s(Nanoseconds interval) {
  ReadingLimit limit;
  int admitted = 0;
  for (Nanoseconds time = 1h; time < 1h + 10s; time += interval) admitted += limit.admits(MonoTime(time)) ? 1 : 0;
  return admitted;
}

TEST(ReadingLimit, LetsASensorPassWhole) {
  EXPECT_EQ(admitted_in_10_s(1s), 10);
  EXPECT_EQ(admitted_in_10_s(10ms), 1000) << "100 a second";
}

TEST(ReadingLimit, LetsOfAFlood100ASecondPassAndABurst) {
  EXPECT_NEAR(admitted_in_10_s(1us), 10 * 100 + 100, 1);
}

TEST(ReadingLimit, AdmitsABurstAtOnceAndNoMoreAfterAPauseOfAnyLength) {
  ReadingLimit limit;
  for (const Nanoseconds time : {Nanoseconds(1s), Nanoseconds(24h)}) {
    int admitted = 0;
    for (int i = 0; i < 1000; ++i) admitted += limit.admits(MonoTime(time)) ? 1 : 0;
    EXPECT_EQ(admitted, 100);
  }
}

}  // namespace
}  // namespace yuragi::drivers::sensor
