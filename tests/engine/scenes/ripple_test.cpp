#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "engine/pose/pose_arrays.hpp"
#include "engine/pose/pose_hash.hpp"
#include "engine/scenes/layered_noise.hpp"
#include "engine/scenes/scene.hpp"
#include "tests/support/bits.hpp"
#include "tests/support/each_simd_row.hpp"
#include "tests/support/gusty_wind.hpp"
#include "tests/support/scripted_wind.hpp"

namespace yuragi::scenes {

extern const Description kRippleScene;

namespace {

constexpr double kRippleTick_s = 1.0 / 60.0;

/// Water of 64 x 64 points, 6.3 m wide: a point each 0.1 m.
std::unique_ptr<Scene> ripple(ParameterValues::Map given = {}, const Setup& setup = {.seed = 1}) {
  given.try_emplace("columns", std::int64_t{64});
  given.try_emplace("rows", std::int64_t{64});
  given.try_emplace("width", 6.3);
  given.try_emplace("depth", 6.3);
  return kRippleScene.make(ParameterValues::resolve(kRippleScene.parameters, given).value(), setup);
}

const std::vector<float>& heights_of(const Scene& scene) {
  return std::get<pose::SurfacePose>(scene.pose()).displacement_m;
}

double rms(const std::vector<float>& values) {
  double squares = 0.0;
  for (const float value : values) squares += static_cast<double>(value) * static_cast<double>(value);
  return std::sqrt(squares / static_cast<double>(values.size()));
}

wind::Vector over_water(double azimuth_rad, double speed_m_s) {
  return {speed_m_s * std::sin(azimuth_rad), speed_m_s * std::cos(azimuth_rad)};
}

void run_ripple(Scene& scene, wind::Vector wind, int ticks) {
  for (int i = 0; i < ticks; ++i) scene.tick(wind, kRippleTick_s);
}

/// How alike the water is to what it was, read (east, south) points away.
double likeness(const std::vector<float>& before, const std::vector<float>& now, int east, int south) {
  double both = 0.0;
  double first = 0.0;
  double second = 0.0;
  for (int row = 10; row < 54; ++row) {
    for (int column = 10; column < 54; ++column) {
      const int here = 64 * row + column;
      const int there = here + 64 * south + east;
      const auto a = static_cast<double>(before[static_cast<std::size_t>(here)]);
      const auto b = static_cast<double>(now[static_cast<std::size_t>(there)]);
      both += a * b;
      first += a * a;
      second += b * b;
    }
  }
  return both / std::sqrt(first * second);
}

TEST(RippleTest, HasThePapers40000PointsByDefaultAndNoHeat) {
  const auto scene = kRippleScene.make(ParameterValues::resolve(kRippleScene.parameters, {}).value(), {.seed = 1});
  EXPECT_EQ(pose::node_count(scene->skeleton()), 40'000U);
  EXPECT_TRUE(std::get<pose::SurfaceSkeleton>(scene->skeleton()).ramp_rgba.empty());
}

TEST(RippleTest, IsFlatInCalmAirAndGrowsFlatAgain) {
  const auto scene = ripple();
  run_ripple(*scene, {}, 100);
  EXPECT_EQ(pose::pose_hash(0, scene->pose()), pose::pose_hash(0, pose::rest_pose(scene->skeleton())));
  run_ripple(*scene, over_water(1.0, 8.0), 300);
  EXPECT_GT(rms(heights_of(*scene)), 0.01);
  run_ripple(*scene, {}, 60 * 60);
  EXPECT_EQ(pose::pose_hash(0, scene->pose()), pose::pose_hash(0, pose::rest_pose(scene->skeleton())));
}

/// The mean square of the slope of a surface of `columns` points a row, `pitch_m` apart.
double mean_square_slope(const std::vector<float>& heights_m, std::size_t columns, double pitch_m) {
  double squares = 0.0;
  double count = 0.0;
  for (std::size_t i = 0; i + columns < heights_m.size(); ++i) {
    if (i % columns == columns - 1) continue;
    const double along = static_cast<double>(heights_m[i + 1]) - static_cast<double>(heights_m[i]);
    const double across = static_cast<double>(heights_m[i + columns]) - static_cast<double>(heights_m[i]);
    squares += (along * along + across * across) / (pitch_m * pitch_m);
    count += 1.0;
  }
  return squares / count;
}

TEST(RippleTest, WavesAreAsSteepAsTheSeasOrAPartOfIt) {
  // A grid of 4 cm, no gusts; the mean over ten moments and 8 m of water.
  for (const double steepness : {0.6, 0.3}) {
    const auto scene = kRippleScene.make(
        ParameterValues::resolve(kRippleScene.parameters, {{"gustiness", 0.0}, {"steepness", steepness}}).value(),
        {.seed = 1});
    for (const double speed_m_s : {1.0, 2.0, 5.0, 15.0, 40.0}) {
      run_ripple(*scene, over_water(1.0, speed_m_s), 400);
      double mean = 0.0;
      for (int moment = 0; moment < 10; ++moment) {
        run_ripple(*scene, over_water(1.0, speed_m_s), 40);
        mean += mean_square_slope(heights_of(*scene), 200, 8.0 / 199.0) / 10.0;
      }
      const double onset = 1.0 - std::exp(-std::pow(speed_m_s / 1.2, 4.0));
      const double sea = (0.003 + 0.00512 * speed_m_s) * onset;
      EXPECT_NEAR(mean / (steepness * sea), 0.92, 0.15) << speed_m_s;  // a grid is less steep than what it is of
    }
  }
}

TEST(RippleTest, WavesAreLongerInAStrongerWind) {
  // By their height for a slope.
  double before_m = 0.0;
  for (const double speed_m_s : {1.5, 4.0, 8.0}) {
    const auto scene = ripple({{"gustiness", 0.0}});
    run_ripple(*scene, over_water(1.0, speed_m_s), 600);
    double height_per_slope_m = 0.0;
    for (int moment = 0; moment < 10; ++moment) {
      run_ripple(*scene, over_water(1.0, speed_m_s), 40);
      height_per_slope_m += rms(heights_of(*scene)) / std::sqrt(mean_square_slope(heights_of(*scene), 64, 0.1));
    }
    EXPECT_GT(height_per_slope_m, 1.05 * before_m) << speed_m_s;
    before_m = height_per_slope_m;
  }
}

TEST(RippleTest, WavesTravelDownwindAtTheirOwnSpeedWhateverTheWinds) {
  // In 0.2 s the two fields of waves, of 1.2 and 0.74 m, go 0.25 and 0.2 m downwind: four or five points of 0.05 m.
  // What was here is then there, and not upwind or where it was, in a breeze as in a storm.
  for (const double speed_m_s : {6.0, 30.0}) {
    for (int eighth = 0; eighth < 8; ++eighth) {
      const double azimuth_rad = eighth * std::numbers::pi / 4.0;
      const auto scene = ripple({{"gustiness", 0.0}, {"width", 3.15}, {"depth", 3.15}});
      run_ripple(*scene, over_water(azimuth_rad, speed_m_s), 600);
      const std::vector<float> before = heights_of(*scene);
      run_ripple(*scene, over_water(azimuth_rad, speed_m_s), 12);
      const int east = static_cast<int>(std::lround(4.4 * std::sin(azimuth_rad)));
      const int south = static_cast<int>(std::lround(-4.4 * std::cos(azimuth_rad)));
      const double downwind = likeness(before, heights_of(*scene), east, south);
      EXPECT_GT(downwind, 0.5) << eighth;
      EXPECT_LT(likeness(before, heights_of(*scene), 0, 0), downwind - 0.2) << eighth;
      EXPECT_LT(likeness(before, heights_of(*scene), -east, -south), downwind - 0.3) << eighth;
    }
  }
}

TEST(RippleTest, TheWaterChangesAsItGoesAndIsNoPictureThatPassesBy) {
  const auto scene = ripple({{"gustiness", 0.0}});
  run_ripple(*scene, over_water(0.0, 8.0), 600);
  const std::vector<float> before = heights_of(*scene);
  // In 0.6 s it goes 0.8 m, eight points: a picture that passes by would be found there whole.
  run_ripple(*scene, over_water(0.0, 8.0), 36);
  double best = 0.0;
  for (int south = -10; south <= 0; ++south) {
    for (int east = -10; east <= 10; ++east) best = std::max(best, likeness(before, heights_of(*scene), east, south));
  }
  EXPECT_LT(best, 0.8);
}

TEST(RippleTest, IsSteepEnoughToBeSeenAndSmoothEnoughForItsGrid) {
  const auto scene = kRippleScene.make(ParameterValues::resolve(kRippleScene.parameters, {}).value(), {.seed = 1});
  run_ripple(*scene, over_water(1.0, 8.0), 300);
  const std::vector<float>& heights_m = heights_of(*scene);
  double slopes = 0.0;
  double bends = 0.0;
  double count = 0.0;
  const double pitch_m = 8.0 / 199.0;
  for (std::size_t i = 1; i + 1 < heights_m.size(); ++i) {
    if (i % 200 == 0 || i % 200 == 199) continue;
    const double before = static_cast<double>(heights_m[i]) - static_cast<double>(heights_m[i - 1]);
    const double behind = static_cast<double>(heights_m[i + 1]) - static_cast<double>(heights_m[i]);
    slopes += before * before / (pitch_m * pitch_m);
    bends += (behind - before) * (behind - before) / (pitch_m * pitch_m);
    count += 1.0;
  }
  EXPECT_GT(std::sqrt(slopes / count), 0.1);
  EXPECT_LT(std::sqrt(bends / count), 0.75 * std::sqrt(slopes / count));  // white noise: 1.7 times
}

TEST(RippleTest, GustsRoughenTheWaterHereAndThere) {
  // Roughness by the corner, over time: with gusts it differs more.
  const auto unevenness = [](double gustiness) {
    const auto scene = ripple({{"gustiness", gustiness}, {"width", 60.0}, {"depth", 60.0}});
    run_ripple(*scene, over_water(1.0, 8.0), 300);
    std::vector<double> squares(16, 0.0);
    for (std::size_t i = 0; i < 4096; ++i) {
      const auto height_m = static_cast<double>(heights_of(*scene)[i]);
      squares[i / 1024 * 4 + i % 64 / 16] += height_m * height_m;
    }
    const auto [least, most] = std::minmax_element(squares.begin(), squares.end());
    return *most / *least;
  };
  EXPECT_GT(unevenness(3.0), 1.5 * unevenness(0.0));
}

TEST(RippleTest, TheWindsGustsRoughenTheWaterWhereTheyAre) {
  // How steep each quarter of a pond of 60 m is goes with the wind there.
  const auto scene = ripple({{"width", 60.0}, {"depth", 60.0}}, {.seed = 1, .gusts = shared_gusts()});
  GustyWind wind({4.0, 0.0}, 0.5F);
  double both = 0.0;
  double first = 0.0;
  double second = 0.0;
  for (int moment = 0; moment < 60; ++moment) {
    for (int tick = 0; tick < 60; ++tick) scene->tick(wind.step(kRippleTick_s), kRippleTick_s);
    std::array<double, 4> steep{};
    std::array<double, 4> blows{};
    for (std::size_t i = 0; i < 4096; ++i) {
      const auto height_m = static_cast<double>(heights_of(*scene)[i]);
      steep[i / 2048 * 2 + i % 64 / 32] += height_m * height_m;
    }
    for (std::size_t i = 0; i < 256; ++i) {
      const double east_m = -30.0 + 4.0 * static_cast<double>(i % 16);
      const double south_m = -30.0 + 4.0 * static_cast<double>(i / 16);
      blows[i / 128 * 2 + i % 16 / 8] += speed_of(wind.wind().at(*shared_gusts(), east_m, south_m));
    }
    for (std::size_t i = 0; i < 4; ++i) {
      const double a = 4.0 * steep[i] / (steep[0] + steep[1] + steep[2] + steep[3]) - 1.0;
      const double b = 4.0 * blows[i] / (blows[0] + blows[1] + blows[2] + blows[3]) - 1.0;
      both += a * b;
      first += a * a;
      second += b * b;
    }
  }
  EXPECT_GT(both / std::sqrt(first * second), 0.4);
}

TEST(LayeredNoiseTest, AGridIsReadToTheSameBitsAsItsPlacesWhetherItLiesAlongTheAxesOrNot) {
  const std::vector<NoiseLayerSpec> layers = {
      {.noise = {.size = 64, .seed = 1}, .period_x_m = 20.0, .period_z_m = 15.0},
      {.noise = {.size = 128, .seed = 2}, .period_x_m = 9.0, .weight = 0.5F}};
  constexpr std::size_t kColumns = 40;
  for (const float turn : {0.0F, 0.2F}) {
    std::vector<float> x_m;
    std::vector<float> z_m;
    for (std::size_t i = 0; i < 30 * kColumns; ++i) {
      const auto column = static_cast<float>(i % kColumns);
      const auto row = static_cast<float>(i / kColumns);
      x_m.push_back(0.1F * column - turn * row - 3.0F);
      z_m.push_back(0.1F * row + turn * column + 2.0F);
    }
    LayeredNoise grid(layers, x_m, z_m, kColumns);
    LayeredNoise places(layers, x_m, z_m);
    for (LayeredNoise* noise : {&grid, &places}) {
      noise->shift(0, 3.3, -1.2);
      noise->shift(1, -0.7, 80.0);
    }
    std::vector<float> as_grid(x_m.size());
    std::vector<float> as_places(x_m.size());
    grid.sample(best_simd_row(), as_grid);
    places.sample(best_simd_row(), as_places);
    EXPECT_EQ(bits_of(as_grid), bits_of(as_places)) << turn;
    EXPECT_GT(rms(as_grid), 0.1);
  }
}

class RippleOnEachRow : public EachSimdRow {};
YURAGI_ON_EACH_ROW(RippleOnEachRow);

TEST_P(RippleOnEachRow, MovesTheSameBitForBit) {
  const auto base = ripple({}, {.seed = 3, .row = kBaseSimdRow});
  const auto scene = ripple({}, {.seed = 3, .row = GetParam()});
  for (std::uint64_t tick = 0; tick < 200; ++tick) {
    base->tick(scripted_wind(tick), kRippleTick_s);
    scene->tick(scripted_wind(tick), kRippleTick_s);
    ASSERT_EQ(pose::pose_hash(0, scene->pose()), pose::pose_hash(0, base->pose()));
  }
}

}  // namespace
}  // namespace yuragi::scenes
