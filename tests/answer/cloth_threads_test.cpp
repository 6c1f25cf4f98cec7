#include "tests/answer/cloth_threads.hpp"

#include <cmath>
#include <limits>
#include <numbers>

#include <gtest/gtest.h>

#include "tests/answer/spectra.hpp"
#include "tests/answer/test_wind.hpp"

namespace yuragi::answer {
namespace {

constexpr double kClothLength_m = 1.8;

/// A flag that stands out to the east.
pose::GridSkeleton level_cloth() {
  pose::GridSkeleton grid;
  grid.columns = 2;
  grid.rows = 61;
  for (auto* axis : {&grid.rest_x_m, &grid.rest_y_m, &grid.rest_z_m}) axis->assign(grid.rows * grid.stride(), 0.0F);
  for (std::size_t row = 0; row < grid.rows; ++row) {
    for (std::size_t column = 0; column < grid.stride(); ++column) {
      grid.rest_x_m[row * grid.stride() + column] =
          static_cast<float>(kClothLength_m * static_cast<double>(row) / static_cast<double>(grid.rows - 1));
      grid.rest_y_m[row * grid.stride() + column] = -0.1F * static_cast<float>(column);
    }
  }
  return grid;
}

/// Waves of several frequencies.
double waves(double t_s) {
  double sum = 0.0;
  for (const double frequency_hz : {0.9, 1.13, 1.41}) {
    sum += std::sin(2.0 * std::numbers::pi * frequency_hz * t_s + frequency_hz);
  }
  return sum;
}

/// It slopes aside by a wave that runs along it at a speed, and grows evenly; and the whole of it turns slowly.
ClothThreads waving(const pose::Skeleton& skeleton, double speed_m_s) {
  const auto& grid = std::get<pose::GridSkeleton>(skeleton);
  ClothThreads threads(grid, 2);
  pose::Kinematics joints(skeleton);
  pose::GridPose pose;
  for (auto* axis : {&pose.offset_x_m, &pose.offset_y_m, &pose.offset_z_m}) axis->assign(grid.rest_x_m.size(), 0.0F);
  const double link_m = kClothLength_m / static_cast<double>(grid.rows - 1);
  for (int tick = 0; tick < 6000; ++tick) {
    const double t_s = tick / kRate_hz;
    double aside_m = 0.0;
    for (std::size_t row = 0; row < grid.rows; ++row) {
      const double way_m = link_m * static_cast<double>(row);
      const double turn = 0.3 * std::sin(2.0 * std::numbers::pi * 0.05 * t_s);
      for (std::size_t column = 0; column < grid.stride(); ++column) {
        pose.offset_z_m[row * grid.stride() + column] = static_cast<float>(aside_m + turn * way_m);
      }
      aside_m += link_m * 0.1 * way_m / kClothLength_m * waves(t_s - way_m / speed_m_s);
    }
    joints.run(pose::Pose(pose));
    threads.tracks().take(joints);
  }
  return threads;
}

TEST(ClothThreads, AWaveThatRunsToTheFlyHasItsSpeed) {
  const pose::Skeleton skeleton = level_cloth();
  for (const double speed_m_s : {1.5, 3.0, 7.0}) {
    const ClothThreads threads = waving(skeleton, speed_m_s);
    const Lag lag = threads.lag(0, {0.0, 1.0});
    EXPECT_NEAR(threads.speed_m_s(lag), speed_m_s, 0.02 * speed_m_s);
    EXPECT_GT(lag.correlation, 0.99);
  }
}

TEST(ClothThreads, WhatSlopesEverywhereAtOnceGrowsAsItsSlopesAddUp) {
  // Slopes of 0.1 s / L add up to 0.05 s^2 / L.
  const pose::Skeleton skeleton = level_cloth();
  const ClothThreads threads = waving(skeleton, 1e9);
  EXPECT_NEAR(threads.length_m(), kClothLength_m, 1e-5);
  EXPECT_GT(threads.speed_m_s(threads.lag(0, {0.0, 1.0})), 100.0);

  Welch welch(kRate_hz);
  const auto across_m = [&](ClothThreads::Joint joint) {
    const std::size_t first = threads.at(0, ClothThreads::Joint::kFirst);
    return welch.of(threads.tracks().way_m(first, threads.at(0, joint), {0.0, 1.0})).deviation_above(kAcrossFrom_hz);
  };
  const double tip_m = across_m(ClothThreads::Joint::kTip);
  EXPECT_NEAR(tip_m, 0.05 * kClothLength_m * std::sqrt(1.5), 0.003);
  EXPECT_NEAR(across_m(ClothThreads::Joint::kQuarter) / tip_m, 1.0 / 16.0, 0.005);
  EXPECT_NEAR(across_m(ClothThreads::Joint::kHalf) / tip_m, 0.25, 0.01);
}

TEST(ClothThreads, AChordThatLiesLevelIsNinetyDegreesFromDown) {
  const pose::Skeleton skeleton = level_cloth();
  EXPECT_NEAR(mean(waving(skeleton, 3.0).chord_deg(0)), 90.0, 1e-3);
}

}  // namespace
}  // namespace yuragi::answer
