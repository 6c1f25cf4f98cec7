#include "tests/answer/swing.hpp"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

namespace yuragi::answer {
namespace {

/// A damped oscillator that is let go from 1.
Series let_go(double natural_hz, double damping) {
  const double omega_rad_s = 2.0 * std::numbers::pi * natural_hz;
  const double damped_rad_s = omega_rad_s * std::sqrt(1.0 - damping * damping);
  Series way;
  for (int i = 0; i < 3000; ++i) {
    const double t_s = i / 60.0;
    way.push_back(static_cast<float>(
        std::exp(-damping * omega_rad_s * t_s) *
        (std::cos(damped_rad_s * t_s) + damping * omega_rad_s / damped_rad_s * std::sin(damped_rad_s * t_s))));
  }
  return way;
}

TEST(Swing, HasTheFrequencyAndTheDampingOfItsOscillator) {
  for (const double damping : {0.1, 0.2, 0.3}) {
    const Swing swing = swing_of(let_go(0.387, damping), 60.0);
    EXPECT_NEAR(swing.frequency_hz, 0.387 * std::sqrt(1.0 - damping * damping), 0.006) << damping;
    EXPECT_NEAR(swing.damping, damping, 0.01) << damping;
  }
}

TEST(Swing, WhatCreepsBackHasNone) {
  Series way;
  for (int i = 0; i < 3000; ++i) way.push_back(static_cast<float>(std::exp(-i / 60.0)));
  EXPECT_TRUE(std::isnan(swing_of(way, 60.0).frequency_hz));
}

}  // namespace
}  // namespace yuragi::answer
