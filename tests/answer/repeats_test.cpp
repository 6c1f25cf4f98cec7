#include "tests/answer/repeats.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "engine/math/philox.hpp"

namespace yuragi::answer {
namespace {

/// A rough series of ten minutes that comes again after `period` samples; 0: it does not.
Series ten_minutes(std::size_t period) {
  const math::RandomStream random(3, math::stream_id("repeats test"));
  Series series;
  for (std::size_t i = 0; i < 36000; ++i) {
    const std::size_t at = period == 0 ? i : i % period;
    double sum = 0.0;
    for (std::size_t k = 0; k < 10; ++k) sum += random.uniform((at + 3 * k) / 30) - 0.5;
    series.push_back(static_cast<float>(sum));
  }
  return series;
}

TEST(Repeats, ARepeatIsFoundWhereItIs) {
  const Repeat repeat = largest_repeat(ten_minutes(4500), 60.0, kSwing_s);
  EXPECT_GT(repeat.correlation, 0.9);
  EXPECT_NEAR(std::fmod(repeat.lag_s + 1.0, 75.0), 1.0, 0.1);
}

TEST(Repeats, WhatDoesNotRepeatHasNone) {
  EXPECT_LT(largest_repeat(ten_minutes(0), 60.0, kSwing_s).correlation, kRepeats);
}

}  // namespace
}  // namespace yuragi::answer
