#include "engine/wind/ground/gust_coherence.hpp"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

namespace yuragi::wind::ground {
namespace {

double root_coherence(const GustCoherence& law, double frequency_hz, double along_m, double across_m) {
  return std::exp(-law.distance_m(along_m, across_m) * law.loss_per_m(frequency_hz));
}

TEST(GustCoherence, AcrossIsIec61400sExponential) {
  const GustCoherence law{.speed_m_s = 7.0, .length_m = 57.0};
  for (const double frequency_hz : {0.05, 0.2, 1.0}) {
    for (const double across_m : {1.0, 3.0, 7.0, 20.0}) {
      // exp(-12 sqrt((f d / U)^2 + (0.12 d / Lc)^2)), where 0.12 / Lc = 1 / (2 pi 1.339 L).
      const double with_length = across_m / (2.0 * std::numbers::pi * 1.339 * 57.0);
      const double iec = std::exp(-12.0 * std::hypot(frequency_hz * across_m / 7.0, with_length));
      EXPECT_NEAR(root_coherence(law, frequency_hz, 0.0, across_m), iec, 1e-12);
      EXPECT_EQ(root_coherence(law, frequency_hz, 0.0, -across_m), root_coherence(law, frequency_hz, 0.0, across_m));
    }
  }
}

TEST(GustCoherence, InLightWindGustsAreWiderAndLiveLonger) {
  EXPECT_EQ(GustCoherence::decay_across_of(0.1), 12.0);
  EXPECT_EQ(GustCoherence::decay_across_of(0.2), 12.0);
  EXPECT_NEAR(GustCoherence::decay_across_of(0.8), 3.0, 1e-12);
  // Measured between pairs of sonic anemometers in a mean wind of about 1.3 m/s: 0.65 and 0.30 across 12.8 m, 0.70 and
  // 0.38 along 14 m. The law of ordinary wind has 0.16 and 0.02, 0.33 and 0.09.
  const GustCoherence law{.speed_m_s = 1.3,
                          .length_m = 25.0,
                          .decay_across = GustCoherence::decay_across_of(0.8),
                          .decay_along = GustCoherence::decay_along_of(0.8)};
  EXPECT_NEAR(root_coherence(law, 0.015, 0.0, 12.8), 0.65, 0.08);
  EXPECT_NEAR(root_coherence(law, 0.035, 0.0, 12.8), 0.30, 0.08);
  EXPECT_NEAR(root_coherence(law, 0.015, 14.0, 0.0), 0.70, 0.08);
  EXPECT_NEAR(root_coherence(law, 0.035, 14.0, 0.0), 0.38, 0.12);
}

TEST(GustCoherence, AlongItsDecayGrowsWithTheTurbulenceOfOrdinaryWind) {
  EXPECT_EQ(GustCoherence::decay_along_of(0.0), 0.5);
  EXPECT_EQ(GustCoherence::decay_along_of(0.08), 0.5);
  EXPECT_NEAR(GustCoherence::decay_along_of(0.2), 1.165, 1e-12);
  EXPECT_NEAR(GustCoherence::decay_along_of(0.33), 1.906, 1e-12);
  EXPECT_NEAR(GustCoherence::decay_along_of(1.0), 1.88925, 1e-12);

  // Without the term of the length: exp(-C_x f d / U).
  const GustCoherence law{.speed_m_s = 5.0, .length_m = 1e9, .decay_along = 1.165};
  EXPECT_NEAR(root_coherence(law, 0.4, 20.0, 0.0), std::exp(-1.165 * 0.4 * 20.0 / 5.0), 1e-9);
  EXPECT_EQ(root_coherence(law, 0.4, -20.0, 0.0), root_coherence(law, 0.4, 20.0, 0.0));
  EXPECT_NEAR(law.distance_m(20.0, 3.0), law.distance_m(20.0, 0.0) + law.distance_m(0.0, 3.0), 1e-12);
}

TEST(GustCoherence, WhatIsAlikeEverywhereIsNeverLost) {
  // At 2 m/s weather is what is slower than 0.003 Hz; at 40 m/s, what is longer than the longest wave.
  for (const double speed_m_s : {0.3, 2.0, 40.0}) {
    const GustCoherence law{.speed_m_s = speed_m_s, .longest_wave_m = 2048.0};
    const double ends_hz = std::max(0.003, speed_m_s / 2048.0);
    EXPECT_EQ(law.loss_per_m(0.0), 0.0);
    EXPECT_EQ(law.loss_per_m(ends_hz), 0.0);
    EXPECT_GT(law.loss_per_m(1.5 * ends_hz), 0.0);
    const double wavenumber_rad_m = 2.0 * std::numbers::pi * 2.0 * ends_hz / speed_m_s;
    EXPECT_NEAR(law.loss_per_m(2.0 * ends_hz), std::hypot(wavenumber_rad_m, 1.0 / (1.339 * law.length_m)), 1e-9);
  }
}

TEST(GustCoherence, QuickerGustsAreLostSooner) {
  const GustCoherence law{.speed_m_s = 3.0};
  double before = 0.0;
  for (double frequency_hz = 0.001; frequency_hz < 20.0; frequency_hz *= 1.1) {
    const double loss_per_m = law.loss_per_m(frequency_hz);
    EXPECT_GE(loss_per_m, before);
    before = loss_per_m;
  }
}

}  // namespace
}  // namespace yuragi::wind::ground
