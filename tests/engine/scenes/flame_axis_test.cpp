#include "engine/scenes/flame_axis.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

namespace yuragi::scenes {
namespace {

constexpr double kAxisTick_s = 1.0 / 60.0;

/// An axis and where its rows are.
struct Axis {
  explicit Axis(const FlameAxisSpec& wanted) : spec(wanted), axis(wanted), numbers(5 * wanted.rows, -1.0F) {}

  void run(double east_m_s, double south_m_s, int ticks) {
    for (int i = 0; i < ticks; ++i) axis.step(east_m_s, south_m_s, kAxisTick_s);
    axis.write({array(0), array(1), array(2), array(3), array(4)});
  }
  std::span<float> array(std::size_t which) { return std::span(numbers).subspan(which * spec.rows, spec.rows); }
  double east_m(std::size_t row) { return static_cast<double>(array(0)[row]); }
  double south_m(std::size_t row) { return static_cast<double>(array(1)[row]); }
  double up_m(std::size_t row) {
    return spec.height_m * static_cast<double>(row) / static_cast<double>(spec.rows - 1) -
           static_cast<double>(array(2)[row]);
  }
  /// Between a row and the one below it.
  double tilt_rad(std::size_t row) {
    return std::atan2(std::hypot(east_m(row) - east_m(row - 1), south_m(row) - south_m(row - 1)),
                      up_m(row) - up_m(row - 1));
  }
  double length_m() {
    double length_m = 0.0;
    for (std::size_t row = 1; row < spec.rows; ++row) {
      length_m += std::hypot(east_m(row) - east_m(row - 1), up_m(row) - up_m(row - 1), south_m(row) - south_m(row - 1));
    }
    return length_m;
  }

  FlameAxisSpec spec;
  FlameAxis axis;
  std::vector<float> numbers;
};

TEST(FlameInWindTest, TiltsAndShrinksAsWasMeasured) {
  EXPECT_EQ(FlameInWind::at(0.0).lean, 0.0);
  EXPECT_EQ(FlameInWind::at(0.0).part, 1.0);
  for (const double u : {0.1, 0.5, 1.0, 2.0, 5.0, 18.6, 72.0}) {
    const FlameInWind flame = FlameInWind::at(u);
    EXPECT_NEAR(std::cos(2.0 * std::atan(flame.lean)), std::pow(1.0 + u * u, -0.25), 1e-12) << u;
    EXPECT_NEAR(flame.part, std::pow(std::max(u, 1.0), -0.21), 0.005) << u;
    EXPECT_LT(flame.lean, 1.0);
  }
}

TEST(FlameAxisTest, StandsUprightInCalmAirExactlyAndAgainAfterAWind) {
  Axis axis({.wobble = 0.0});
  axis.run(0.0, 0.0, 100);
  EXPECT_TRUE(std::all_of(axis.numbers.begin(), axis.numbers.end(), [](float way) { return way == 0.0F; }));
  axis.run(5.0, 3.0, 100);
  EXPECT_GT(axis.east_m(95), 0.1);
  axis.run(0.0, 0.0, 1200);
  EXPECT_TRUE(std::all_of(axis.numbers.begin(), axis.numbers.end(), [](float way) { return way == 0.0F; }));
}

TEST(FlameAxisTest, LiesOverDownwindAsTheLawHasItAndIsAsLong) {
  for (const double speed_m_s : {0.9, 4.4, 15.5}) {
    Axis axis({.wobble = 0.0});
    axis.run(0.6 * speed_m_s, -0.8 * speed_m_s, 600);
    // What there is of the wind at 0.6 m, and u* of wood on half a metre.
    const double felt = std::log(0.6 / 0.03) / std::log(10.0 / 0.03);
    const double u = felt * speed_m_s / std::cbrt(9.81 * 0.02 * 0.5 / 1.2);
    EXPECT_NEAR(std::cos(axis.tilt_rad(95)), std::pow(1.0 + u * u, -0.25), 1e-3) << speed_m_s;
    EXPECT_NEAR(axis.length_m(), 1.2 * std::pow(std::max(u, 1.0), -0.21), 0.006) << speed_m_s;
    EXPECT_NEAR(axis.south_m(95) / axis.east_m(95), -0.8 / 0.6, 1e-4);
    // It bends over its foot, which stays where it is; and it slopes by the tangent of half the tilt.
    EXPECT_EQ(axis.east_m(0), 0.0);
    EXPECT_LT(axis.tilt_rad(1), 0.3 * axis.tilt_rad(95));
    EXPECT_GT(axis.tilt_rad(12), 0.9 * axis.tilt_rad(95));
    EXPECT_NEAR(std::hypot(axis.array(3)[95], axis.array(4)[95]), std::tan(axis.tilt_rad(95) / 2.0), 1e-3);
  }
}

TEST(FlameAxisTest, AGustRunsUpTheAxisWithTheGas) {
  Axis axis({.height_m = 2.4, .rise_m_s = 2.0, .wobble = 0.0});
  axis.run(1.0, 0.0, 600);
  const double before_rad = axis.tilt_rad(90);
  axis.run(8.0, 0.0, 40);  // in 0.67 s the gas has come to row 53 of 95
  EXPECT_GT(axis.tilt_rad(20), before_rad + 0.3);
  EXPECT_NEAR(axis.tilt_rad(60), before_rad, 1e-5);
  axis.run(8.0, 0.0, 80);
  EXPECT_GT(axis.tilt_rad(90), before_rad + 0.3);
}

TEST(FlameAxisTest, SwaysByItselfAroundUpright) {
  Axis axis({.wobble = 0.1});
  double squares = 0.0;
  double sum = 0.0;
  for (int i = 0; i < 3000; ++i) {
    axis.run(0.0, 0.0, 4);
    const auto slope = static_cast<double>(axis.array(3)[95]);
    sum += slope / 3000.0;
    squares += slope * slope / 3000.0;
  }
  EXPECT_NEAR(sum, 0.0, 0.02);
  EXPECT_NEAR(std::sqrt(squares), 0.1, 0.02);
}

TEST(FlameAxisTest, NoWindMovesARowFartherThanItsBound) {
  Axis axis({});
  std::vector<float> before(axis.numbers.size(), 0.0F);
  double largest_m = 0.0;
  for (int tick = 0; tick < 1200; ++tick) {
    const double speed_m_s = tick / 7 % 3 == 0 ? 0.0 : 60.0 * std::cos(0.37 * tick);
    axis.run(speed_m_s * std::cos(0.01 * tick), speed_m_s * std::sin(0.01 * tick), 1);
    for (std::size_t row = 0; row < 96; ++row) {
      const auto moved = [&](std::size_t which) {
        return static_cast<double>(axis.array(which)[row] - before[which * 96 + row]);
      };
      const double step_m = std::hypot(moved(0), moved(1), moved(2));
      largest_m = std::max(largest_m, step_m);
      ASSERT_LE(step_m, axis.axis.largest_step_m(kAxisTick_s));
      ASSERT_LE(std::hypot(moved(3), moved(4)), axis.axis.largest_slope_step(kAxisTick_s));
      ASSERT_LE(std::hypot(axis.array(3)[row], axis.array(4)[row]), axis.axis.largest_slope());
    }
    before = axis.numbers;
  }
  EXPECT_GT(largest_m, 0.05 * axis.axis.largest_step_m(kAxisTick_s));
}

}  // namespace
}  // namespace yuragi::scenes
