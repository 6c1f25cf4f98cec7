#include "engine/wind/shaping/speed_memory.hpp"

#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "engine/wind/shaping/soft_ceiling.hpp"

namespace yuragi::wind::shaping {
namespace {

constexpr double kDay_s = 86400.0;

TEST(SpeedMemory, KnowsThePercentilesOfWhatBlew) {
  // Equally long at each of 1000 speeds from 0 to 20 m/s.
  SpeedMemory memory(1000.0 * kDay_s);
  for (int i = 0; i < 1000; ++i) memory.add(0.02 * (i + 0.5), 60.0);
  for (const double share : {0.1, 0.25, 0.5, 0.75, 0.95}) {
    EXPECT_NEAR(memory.percentile(share), 20.0 * share, 0.02 * 20.0 * share) << share;
  }
  EXPECT_NEAR(memory.known_s(), 60'000.0, 60.0);
}

TEST(SpeedMemory, ForgetsAsItsMemorySays) {
  SpeedMemory memory(kDay_s);
  for (int i = 0; i < 24 * 60; ++i) memory.add(2.0, 60.0);
  EXPECT_NEAR(memory.known_s(), kDay_s * (1.0 - std::exp(-1.0)), 60.0);
  for (int i = 0; i < 24 * 60; ++i) memory.add(8.0, 60.0);
  // The day before has 1/e of its weight.
  const double before = std::exp(-1.0) / (1.0 + std::exp(-1.0));
  EXPECT_NEAR(memory.percentile(before - 0.01), 2.0, 0.2);
  EXPECT_NEAR(memory.percentile(before + 0.01), 8.0, 0.8);
}

TEST(SpeedMemory, KnowsNothingAtFirstAndTakesAnySpeed) {
  SpeedMemory memory(kDay_s);
  EXPECT_EQ(memory.percentile(0.5), 0.0);
  memory.add(0.0, 1.0);
  EXPECT_LE(memory.percentile(1.0), 0.06);
  memory.add(1e9, 10.0);
  memory.add(5.0, 0.0);
  memory.add(5.0, -3.0);
  EXPECT_NEAR(memory.known_s(), 11.0, 0.01);
  EXPECT_TRUE(std::isfinite(memory.percentile(0.95)));
}

TEST(SpeedMemory, ComesBackFromItsNumbersAndRefusesOthers) {
  SpeedMemory memory(7.0 * kDay_s);
  for (int i = 1; i < 500; ++i) memory.add(0.03 * i, 600.0);
  SpeedMemory again(7.0 * kDay_s);
  ASSERT_TRUE(again.restore(memory.times_s()));
  EXPECT_EQ(again.percentile(0.5), memory.percentile(0.5));
  EXPECT_EQ(again.known_s(), memory.known_s());

  // What is more than it can hold keeps its proportions.
  SpeedMemory shorter(kDay_s);
  ASSERT_TRUE(shorter.restore(memory.times_s()));
  EXPECT_NEAR(shorter.percentile(0.5), memory.percentile(0.5), 1e-9);
  EXPECT_NEAR(shorter.known_s(), kDay_s, 1e-6);

  std::vector<double> wrong(SpeedMemory::kBins, 1.0);
  for (const double value : {-1.0, std::nan(""), std::numeric_limits<double>::infinity(), 1e300}) {
    wrong[7] = value;
    EXPECT_FALSE(again.restore(wrong)) << value;
  }
  wrong.pop_back();
  EXPECT_FALSE(again.restore(wrong));
  EXPECT_EQ(again.percentile(0.5), memory.percentile(0.5)) << "what is refused changes nothing";
}

TEST(SoftCeiling, LetsThroughWhatIsBelowAndNeverReachesTheMost) {
  constexpr SoftCeiling kCeiling{.from_m_s = 17.0, .most_m_s = 25.0};
  for (const double speed_m_s : {0.0, 1e-300, 3.0, 16.999, 17.0}) EXPECT_EQ(kCeiling.gain(speed_m_s), 1.0);
  double before_m_s = 17.0;
  for (double speed_m_s = 17.01; speed_m_s < 1e6; speed_m_s *= 1.001) {
    const double held_m_s = kCeiling.gain(speed_m_s) * speed_m_s;
    EXPECT_GT(held_m_s, before_m_s) << "at " << speed_m_s;
    EXPECT_LT(held_m_s, 25.0) << "at " << speed_m_s;
    before_m_s = held_m_s;
  }
}

TEST(SoftCeiling, LeavesTheStraightLineWithoutAKink) {
  constexpr SoftCeiling kCeiling{.from_m_s = 17.0, .most_m_s = 25.0};
  const auto held = [&](double speed_m_s) { return kCeiling.gain(speed_m_s) * speed_m_s; };
  constexpr double kStep_m_s = 1e-4;
  // The slope falls from 1 by 2/R for each m/s: no step in it anywhere.
  double slope = 1.0;
  for (double speed_m_s = 16.0; speed_m_s < 40.0; speed_m_s += 0.01) {
    const double next = (held(speed_m_s + kStep_m_s) - held(speed_m_s)) / kStep_m_s;
    EXPECT_LE(std::abs(next - slope), 0.01 * 2.0 / 8.0 + 1e-6) << "at " << speed_m_s;
    slope = next;
  }
}

TEST(SoftCeiling, WithoutValuesIsNone) {
  EXPECT_EQ(SoftCeiling{}.gain(1e9), 1.0);
}

}  // namespace
}  // namespace yuragi::wind::shaping
