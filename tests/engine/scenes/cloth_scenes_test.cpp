// What curtain, flag and banner have in common, and what each is there for.

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "engine/base/units.hpp"
#include "engine/pose/pose_arrays.hpp"
#include "engine/scenes/scene.hpp"
#include "tests/support/bits.hpp"

namespace yuragi::scenes {

extern const Description kBannerScene;
extern const Description kCurtainScene;
extern const Description kFlagScene;

namespace {

constexpr double kClothTick_s = 1.0 / 60.0;

std::unique_ptr<Scene> cloth(const Description& kind, const ParameterValues::Map& given = {},
                             const Placement& placement = {}) {
  return kind.make(ParameterValues::resolve(kind.parameters, given).value(), {.seed = 1, .placement = placement});
}

/// The same, with a banner whose arm does not turn.
std::unique_ptr<Scene> held_cloth(const Description& kind, ParameterValues::Map given = {},
                                  const Placement& placement = {}) {
  if (&kind == &kBannerScene) given["turns"] = false;
  return cloth(kind, given, placement);
}

const pose::GridSkeleton& grid_of(const Scene& scene) {
  return std::get<pose::GridSkeleton>(scene.skeleton());
}
const pose::GridPose& offsets_of(const Scene& scene) {
  return std::get<pose::GridPose>(scene.pose());
}

wind::Vector cloth_wind(double azimuth_deg, double speed_m_s) {
  return {speed_m_s * std::sin(azimuth_deg * kRadPerDeg), speed_m_s * std::cos(azimuth_deg * kRadPerDeg)};
}

void blow_on(Scene& scene, wind::Vector wind, int ticks) {
  for (int i = 0; i < ticks; ++i) scene.tick(wind, kClothTick_s);
}

struct Place {
  double x = 0.0, y = 0.0, z = 0.0;

  friend Place operator-(Place a, Place b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
  double length() const { return std::hypot(x, y, z); }
};

Place rest_at(const Scene& scene, std::size_t column, std::size_t row) {
  const pose::GridSkeleton& grid = grid_of(scene);
  const std::size_t at = row * grid.stride() + column;
  return {static_cast<double>(grid.rest_x_m[at]), static_cast<double>(grid.rest_y_m[at]),
          static_cast<double>(grid.rest_z_m[at])};
}
Place offset_at(const Scene& scene, std::size_t column, std::size_t row) {
  const pose::GridPose& pose = offsets_of(scene);
  const std::size_t at = row * grid_of(scene).stride() + column;
  return {static_cast<double>(pose.offset_x_m[at]), static_cast<double>(pose.offset_y_m[at]),
          static_cast<double>(pose.offset_z_m[at])};
}
Place place_at(const Scene& scene, std::size_t column, std::size_t row) {
  const Place rest = rest_at(scene, column, row);
  const Place offset = offset_at(scene, column, row);
  return {rest.x + offset.x, rest.y + offset.y, rest.z + offset.z};
}

/// The free edge's offset, averaged over its columns and over some ticks.
Place mean_free_edge(Scene& scene, wind::Vector wind, int ticks) {
  Place mean;
  const pose::GridSkeleton& grid = grid_of(scene);
  const double share = 1.0 / static_cast<double>(grid.columns) / ticks;
  for (int tick = 0; tick < ticks; ++tick) {
    scene.tick(wind, kClothTick_s);
    for (std::size_t column = 0; column < grid.columns; ++column) {
      const Place offset = offset_at(scene, column, grid.rows - 1);
      mean = {mean.x + share * offset.x, mean.y + share * offset.y, mean.z + share * offset.z};
    }
  }
  return mean;
}

/// By how many ticks `later` comes after `earlier`: where their cross-correlation is highest, from 0 to `most`.
int lag_ticks(const std::vector<double>& earlier, const std::vector<double>& later, int most) {
  const auto fluctuation = [](std::vector<double> values) {
    double mean = 0.0;
    for (const double value : values) mean += value / static_cast<double>(values.size());
    for (double& value : values) value -= mean;
    return values;
  };
  const std::vector<double> a = fluctuation(earlier);
  const std::vector<double> b = fluctuation(later);
  int best = 0;
  double highest = -1e300;
  for (int lag = 0; lag <= most; ++lag) {
    double sum = 0.0;
    for (std::size_t i = 0; i + static_cast<std::size_t>(most) < a.size(); ++i) {
      sum += a[i] * b[i + static_cast<std::size_t>(lag)];
    }
    if (sum > highest) {
      highest = sum;
      best = lag;
    }
  }
  return best;
}

class ClothScene : public testing::TestWithParam<const Description*> {};
INSTANTIATE_TEST_SUITE_P(Cloths, ClothScene, testing::Values(&kCurtainScene, &kFlagScene, &kBannerScene),
                         [](const auto& scene) { return std::string(scene.param->name); });

TEST_P(ClothScene, CalmIsExactlyTheRestPoseAndComesBackAfterAStorm) {
  const auto scene = held_cloth(*GetParam());
  const auto is_at_rest = [&] {
    bool same = true;
    const pose::Arrays<const float> now(scene->pose());
    for (const auto array : now) {
      same = same && std::all_of(array.begin(), array.end(), [](float offset_m) { return offset_m == 0.0F; });
    }
    return same;
  };
  blow_on(*scene, {}, 100);
  EXPECT_TRUE(is_at_rest());
  blow_on(*scene, cloth_wind(70.0, 20.0), 100);
  EXPECT_FALSE(is_at_rest());
  blow_on(*scene, {}, 1800);  // a curtain swings on for some while
  EXPECT_TRUE(is_at_rest());
}

TEST_P(ClothScene, ThreadsKeepTheirLengthAndFixedEdgesDoNotMove) {
  const auto scene = held_cloth(*GetParam());
  const pose::GridSkeleton& grid = grid_of(*scene);
  for (int storm = 0; storm < 6; ++storm) {
    blow_on(*scene, cloth_wind(80.0 * storm, 12.0 * storm), 40);
    for (std::size_t column = 0; column < grid.columns; ++column) {
      EXPECT_EQ(offset_at(*scene, column, 0).length(), 0.0);
      double length_m = 0.0;
      double rest_m = 0.0;
      for (std::size_t row = 1; row < grid.rows; ++row) {
        length_m += (place_at(*scene, column, row) - place_at(*scene, column, row - 1)).length();
        rest_m += (rest_at(*scene, column, row) - rest_at(*scene, column, row - 1)).length();
      }
      EXPECT_NEAR(length_m, rest_m, 1e-3 * rest_m);
    }
    if (!grid.is_first_column_fixed) continue;
    for (std::size_t row = 0; row < grid.rows; ++row) EXPECT_EQ(offset_at(*scene, 0, row).length(), 0.0);
  }
}

TEST_P(ClothScene, MovesMoreTowardTheFreeEdge) {
  const auto scene = held_cloth(*GetParam());
  const pose::GridSkeleton& grid = grid_of(*scene);
  const std::size_t column = grid.columns - 1;
  blow_on(*scene, cloth_wind(30.0, 8.0), 200);
  std::vector<double> sum(10), square(10);
  constexpr int kTicks = 1200;
  for (int tick = 0; tick < kTicks; ++tick) {
    scene->tick(cloth_wind(30.0, 8.0), kClothTick_s);
    for (std::size_t i = 0; i < 10; ++i) {
      const double z_m = offset_at(*scene, column, (i + 1) * (grid.rows - 1) / 10).z;
      sum[i] += z_m / kTicks;
      square[i] += z_m * z_m / kTicks;
    }
  }
  for (std::size_t i = 1; i < 10; ++i) {
    EXPECT_GT(square[i] - sum[i] * sum[i], square[i - 1] - sum[i - 1] * sum[i - 1]) << i;
  }
}

TEST_P(ClothScene, MovesMoreInAStrongerWindAndSaturates) {
  std::vector<double> reach_m;
  for (const double speed_m_s : {1.0, 2.5, 5.0, 40.0, 1e6}) {
    const auto scene = held_cloth(*GetParam(), {{"max_flutter", 0.0}});
    blow_on(*scene, cloth_wind(0.0, speed_m_s), 200);
    reach_m.push_back(mean_free_edge(*scene, cloth_wind(0.0, speed_m_s), 1000).length());
  }
  for (std::size_t i = 1; i < 3; ++i) EXPECT_GT(reach_m[i], 1.2 * reach_m[i - 1]) << i;
  EXPECT_LT(std::abs(reach_m[4] - reach_m[3]), 0.25 * reach_m[3]);
}

TEST_P(ClothScene, ATurnedWindTurnsTheResponse) {
  // The whole scene turned with the wind moves as before, turned.
  const auto scene = held_cloth(*GetParam(), {{"max_flutter", 0.0}});
  const auto turned = held_cloth(*GetParam(), {{"max_flutter", 0.0}}, {.heading_deg = 90.0});
  const Place mean = mean_free_edge(*scene, cloth_wind(20.0, 6.0), 1500);
  const Place turned_mean = mean_free_edge(*turned, cloth_wind(110.0, 6.0), 1500);
  EXPECT_NEAR(turned_mean.x, -mean.z, 0.15 * mean.length());
  EXPECT_NEAR(turned_mean.z, mean.x, 0.15 * mean.length());
  EXPECT_NEAR(turned_mean.y, mean.y, 0.15 * mean.length());

  // A wind from the other side blows it to the other side.
  const auto reversed = held_cloth(*GetParam(), {{"max_flutter", 0.0}});
  const Place reversed_mean = mean_free_edge(*reversed, cloth_wind(200.0, 6.0), 1500);
  EXPECT_LT(reversed_mean.z * mean.z, 0.0);
}

TEST(ClothSceneTest, WavesRunAlongFlagAndBannerAtTheirPartOfTheWind) {
  for (const Description* kind : {&kFlagScene, &kBannerScene}) {
    const auto scene = held_cloth(*kind, {{"wave_speed", 0.5}});
    const pose::GridSkeleton& grid = grid_of(*scene);
    const std::size_t column = grid.columns - 1;
    const std::size_t early = grid.rows / 2;
    const std::size_t late = grid.rows - 10;
    const double way_m = (rest_at(*scene, column, late) - rest_at(*scene, column, early)).length();
    for (const double speed_m_s : {3.0, 6.0, 12.0}) {
      const wind::Vector wind = cloth_wind(90.0, speed_m_s);  // along the banner, so that it has no belly
      blow_on(*scene, wind, 300);
      std::vector<double> early_m, late_m;
      for (int tick = 0; tick < 3000; ++tick) {
        scene->tick(wind, kClothTick_s);
        early_m.push_back(offset_at(*scene, column, early + 1).z - offset_at(*scene, column, early).z);
        late_m.push_back(offset_at(*scene, column, late + 1).z - offset_at(*scene, column, late).z);
      }
      const double expected_ticks = way_m / (0.5 * speed_m_s) / kClothTick_s;
      EXPECT_NEAR(lag_ticks(early_m, late_m, 90), expected_ticks, 1.0 + 0.1 * expected_ticks)
          << kind->name << speed_m_s;
    }
  }
}

TEST_P(ClothScene, HybridZeroIsTheNoiseAloneBitForBitAndMoreIsNot) {
  const auto noise = cloth(*GetParam());
  const auto zero = cloth(*GetParam(), {{"hybrid", 0.0}});
  const auto half = cloth(*GetParam(), {{"hybrid", 0.5}});
  for (Scene* each : {noise.get(), zero.get(), half.get()}) blow_on(*each, cloth_wind(40.0, 7.0), 60);
  EXPECT_EQ(bits_of(offsets_of(*zero).offset_z_m), bits_of(offsets_of(*noise).offset_z_m));
  EXPECT_NE(bits_of(offsets_of(*half).offset_z_m), bits_of(offsets_of(*noise).offset_z_m));
}

TEST_P(ClothScene, TheHybridKeepsWhatTheNoiseKeeps) {
  const auto scene = held_cloth(*GetParam(), {{"hybrid", 1.0}});
  const pose::GridSkeleton& grid = grid_of(*scene);
  const double bound_m = scene->largest_joint_step_m(kClothTick_s);
  blow_on(*scene, {}, 100);
  for (const float offset_m : offsets_of(*scene).offset_z_m) ASSERT_EQ(offset_m, 0.0F);

  // Steps, gaps, reversals: threads keep their length, fixed edges stay, and no joint moves beyond the bound.
  pose::GridPose before = offsets_of(*scene);
  for (int tick = 0; tick < 400; ++tick) {
    const int round = tick / 70;
    const double speed_m_s = tick % 70 < 50 ? 10.0 * round : 0.0;
    scene->tick(cloth_wind(tick / 35 % 2 == 0 ? 30.0 : 200.0, speed_m_s), kClothTick_s);
    const pose::GridPose& now = offsets_of(*scene);
    for (std::size_t i = 0; i < now.offset_x_m.size(); ++i) {
      const double x = static_cast<double>(now.offset_x_m[i] - before.offset_x_m[i]);
      const double y = static_cast<double>(now.offset_y_m[i] - before.offset_y_m[i]);
      const double z = static_cast<double>(now.offset_z_m[i] - before.offset_z_m[i]);
      ASSERT_LE(std::sqrt(x * x + y * y + z * z), bound_m) << tick;  // and with it: finite
    }
    before = now;
  }
  for (std::size_t column = 0; column < grid.columns; ++column) {
    double length_m = 0.0;
    double rest_m = 0.0;
    for (std::size_t row = 1; row < grid.rows; ++row) {
      length_m += (place_at(*scene, column, row) - place_at(*scene, column, row - 1)).length();
      rest_m += (rest_at(*scene, column, row) - rest_at(*scene, column, row - 1)).length();
    }
    EXPECT_NEAR(length_m, rest_m, 1e-3 * rest_m);
    EXPECT_EQ(offset_at(*scene, column, 0).length(), 0.0);
  }
  if (!grid.is_first_column_fixed) return;
  for (std::size_t row = 0; row < grid.rows; ++row) EXPECT_EQ(offset_at(*scene, 0, row).length(), 0.0);
}

TEST_P(ClothScene, EveryRowComputesTheSameBitsNoiseAndHybrid) {
  for (const double hybrid : {0.0, 0.6}) {
    std::vector<std::uint32_t> base;
    for (const SimdRow row : kSimdRows) {
      if (!is_runnable(row)) continue;
      const auto values = ParameterValues::resolve(GetParam()->parameters, {{"hybrid", hybrid}}).value();
      const auto scene = GetParam()->make(values, {.seed = 1, .row = row});
      blow_on(*scene, cloth_wind(250.0, 9.0), 100);
      const auto bits = bits_of(offsets_of(*scene).offset_x_m);
      if (base.empty()) base = bits;
      EXPECT_EQ(bits, base) << name_of(row);
    }
  }
}

TEST(ClothSceneTest, CurtainAndFlagHaveThePapers30000Joints) {
  for (const Description* kind : {&kCurtainScene, &kFlagScene}) {
    EXPECT_EQ(pose::node_count(cloth(*kind)->skeleton()), 30'000U);
  }
}

/// How far a flag's links are turned from the hoist to the fly, seen from above, from downwind (toward south).
double turn_rad(const Scene& scene, std::size_t column, std::size_t row) {
  const Place way = place_at(scene, column, row + 1) - place_at(scene, column, row);
  return std::atan2(way.x, way.z);
}

TEST(FlagTest, ItsFoldsLieAlongTheTensionFromTheUpperHoistCorner) {
  // The structure tensor of the turns over the cloth as it lies flat: across the folds is its larger axis.
  const auto scene = cloth(kFlagScene);
  const pose::GridSkeleton& grid = grid_of(*scene);
  const double along_m = 1.8 / static_cast<double>(grid.rows - 1);
  const double down_m = 1.2 / static_cast<double>(grid.columns - 1);
  for (const double speed_m_s : {6.0, 12.0}) {
    double xx = 0.0, xy = 0.0, yy = 0.0;
    for (int moment = 0; moment < 60; ++moment) {
      blow_on(*scene, cloth_wind(180.0, speed_m_s), 10);
      for (std::size_t row = grid.rows / 3; row + 12 < grid.rows; row += 5) {
        for (std::size_t column = 0; column + 10 < grid.columns; column += 7) {
          const double turn = turn_rad(*scene, column, row);
          const double x = (turn_rad(*scene, column, row + 5) - turn) / (5.0 * along_m);
          const double y = (turn_rad(*scene, column + 10, row) - turn) / (10.0 * down_m);
          if (std::abs(x) > 20.0 || std::abs(y) > 20.0) continue;  // it has turned about
          xx += x * x;
          xy += x * y;
          yy += y * y;
        }
      }
    }
    // Of the folds to the hoist; above 0 they go down toward the fly.
    const double lean_deg = -0.5 * std::atan2(2.0 * xy, xx - yy) / kRadPerDeg;
    EXPECT_GT(lean_deg, 15.0) << speed_m_s;
    EXPECT_LT(lean_deg, 60.0) << speed_m_s;
  }
}

TEST(FlagTest, TheFlysCornersCurl) {
  const auto scene = cloth(kFlagScene);
  const pose::GridSkeleton& grid = grid_of(*scene);
  double lower = 0.0, upper = 0.0, middle = 0.0;
  for (int moment = 0; moment < 600; ++moment) {
    blow_on(*scene, cloth_wind(180.0, 9.0), 3);
    // Over the last sixth of the way to the fly.
    const auto curl_rad = [&](std::size_t column) {
      const double turn = turn_rad(*scene, column, grid.rows - 2) - turn_rad(*scene, column, grid.rows * 5 / 6);
      return std::remainder(turn, 2.0 * kPi);
    };
    lower += std::pow(curl_rad(grid.columns - 1), 2);
    upper += std::pow(curl_rad(0), 2);
    middle += std::pow(curl_rad(grid.columns / 2), 2);
  }
  EXPECT_GT(lower, 1.5 * middle);
  EXPECT_GT(upper, 1.1 * middle);
  EXPECT_GT(lower, upper);
}

/// The root of the mean square of a number's distance from its mean, over so many ticks of a steady wind.
template <typename Number>
double deviation_in(Scene& scene, wind::Vector wind, int ticks, Number number) {
  double sum = 0.0, square = 0.0;
  for (int tick = 0; tick < ticks; ++tick) {
    scene.tick(wind, kClothTick_s);
    const double value = number();
    sum += value / ticks;
    square += value * value / ticks;
  }
  return std::sqrt(square - sum * sum);
}

TEST(BannerTest, ItsLowerEndSwingsInABreeze) {
  const auto scene = cloth(kBannerScene);
  const pose::GridSkeleton& grid = grid_of(*scene);
  const wind::Vector wind = cloth_wind(90.0, 4.0);  // along its arm
  blow_on(*scene, wind, 300);
  EXPECT_GT(deviation_in(*scene, wind, 1800, [&] { return offset_at(*scene, grid.columns - 1, grid.rows - 1).z; }),
            0.09);
}

TEST(CurtainTest, AWindAlongTheCurtainRunsAlongIt) {
  const auto scene = cloth(kCurtainScene, {{"wave_speed", 0.5}});
  const pose::GridSkeleton& grid = grid_of(*scene);
  const std::size_t row = grid.rows / 4;
  const double way_m = (rest_at(*scene, 150, 0) - rest_at(*scene, 100, 0)).x;
  for (const double speed_m_s : {3.0, 6.0}) {
    for (const double azimuth_deg : {90.0, 270.0}) {  // toward east, and back
      const wind::Vector wind = cloth_wind(azimuth_deg, speed_m_s);
      blow_on(*scene, wind, 400);
      std::vector<double> west_m, east_m;
      for (int tick = 0; tick < 3000; ++tick) {
        scene->tick(wind, kClothTick_s);
        west_m.push_back(offset_at(*scene, 100, row + 1).z - offset_at(*scene, 100, row).z);
        east_m.push_back(offset_at(*scene, 150, row + 1).z - offset_at(*scene, 150, row).z);
      }
      const int lag = azimuth_deg < 180.0 ? lag_ticks(west_m, east_m, 60) : lag_ticks(east_m, west_m, 60);
      EXPECT_NEAR(lag, way_m / (0.5 * speed_m_s) / kClothTick_s, 2.0) << speed_m_s << " m/s toward " << azimuth_deg;
    }
  }
}

/// Where the middle of the hem is, out of the curtain's plane.
double hem_m(const Scene& scene) {
  return offset_at(scene, grid_of(scene).columns / 2, grid_of(scene).rows - 1).z;
}

TEST(CurtainTest, TheWindHoldsItWhereItsForceAndItsWeightAre) {
  // At half_sway_speed its upper end would stand at 45 degrees, and 0.8 of that as a tangent with the hem's weight.
  const auto scene = cloth(kCurtainScene, {{"max_flutter", 0.0}, {"bulges", 0.0}, {"fold_depth", 0.0}});
  blow_on(*scene, cloth_wind(180.0, 5.0), 1200);
  const std::size_t column = grid_of(*scene).columns / 2;
  const Place first = place_at(*scene, column, 1) - place_at(*scene, column, 0);
  const Place last = place_at(*scene, column, 149) - place_at(*scene, column, 148);
  EXPECT_NEAR(first.z / -first.y, 0.8, 0.03);
  EXPECT_LT(last.z / -last.y, 0.1);
  EXPECT_GT(hem_m(*scene), 1.0);
}

TEST(CurtainTest, BreathesInASteadyBreeze) {
  for (const double speed_m_s : {2.0, 3.0, 4.0}) {
    const auto scene = cloth(kCurtainScene);
    blow_on(*scene, cloth_wind(180.0, speed_m_s), 600);
    const double breath_m = deviation_in(*scene, cloth_wind(180.0, speed_m_s), 3600, [&] { return hem_m(*scene); });
    EXPECT_GT(breath_m, 0.06 * speed_m_s) << speed_m_s;
  }
}

TEST(CurtainTest, SwingsOnAsAHangingChainDoes) {
  const auto scene = cloth(kCurtainScene, {{"max_flutter", 0.0}, {"bulges", 0.0}});
  blow_on(*scene, cloth_wind(180.0, 2.0), 1200);
  std::vector<int> crossings;
  double before_m = hem_m(*scene);
  for (int tick = 0; tick < 360; ++tick) {
    scene->tick(wind::Vector{}, kClothTick_s);
    if (hem_m(*scene) * before_m < 0.0) crossings.push_back(tick);
    before_m = hem_m(*scene);
  }
  // 1.2024 sqrt(g / L) / 2 pi = 0.387 Hz, a little less with damping 0.3.
  ASSERT_GE(crossings.size(), 3U);
  EXPECT_NEAR((crossings[2] - crossings[0]) * kClothTick_s, 1.0 / (0.387 * std::sqrt(1.0 - 0.09)), 0.1);
}

TEST(FlagTest, DragAndWeightLiftIt) {
  const auto scene = cloth(kFlagScene, {{"max_flutter", 0.0}, {"droop", 0.0}, {"fold_angle", 0.0}});
  for (const double speed_m_s : {1.5, 3.0, 6.0}) {
    blow_on(*scene, cloth_wind(0.0, speed_m_s), 600);
    const Place tip = place_at(*scene, 100, 149) - place_at(*scene, 100, 0);
    EXPECT_NEAR(std::hypot(tip.x, tip.z) / -tip.y, speed_m_s * speed_m_s / 9.0, 1e-3 * speed_m_s * speed_m_s);
  }
}

TEST(FlagTest, HangsLimpInCalmAirAndFliesDownwind) {
  const auto scene = cloth(kFlagScene);
  const pose::GridSkeleton& grid = grid_of(*scene);
  const std::size_t middle = grid.columns / 2;
  const auto fly = [&] { return place_at(*scene, middle, grid.rows - 1) - rest_at(*scene, middle, 0); };
  EXPECT_LT(fly().y, -0.9 * 1.8);
  for (int eighth = 0; eighth < 8; ++eighth) {
    const double azimuth_deg = 45.0 * eighth;
    blow_on(*scene, cloth_wind(azimuth_deg, 12.0), 120);
    Place mean;
    for (int tick = 0; tick < 600; ++tick) {
      scene->tick(cloth_wind(azimuth_deg, 12.0), kClothTick_s);
      mean = {mean.x + fly().x / 600.0, mean.y + fly().y / 600.0, mean.z + fly().z / 600.0};
    }
    const double downwind_m = mean.x * std::sin(azimuth_deg * kRadPerDeg) - mean.z * std::cos(azimuth_deg * kRadPerDeg);
    const double sideways_m = mean.x * std::cos(azimuth_deg * kRadPerDeg) + mean.z * std::sin(azimuth_deg * kRadPerDeg);
    EXPECT_GT(downwind_m, 0.75 * 1.8) << azimuth_deg;
    EXPECT_LT(std::abs(sideways_m), 0.2) << azimuth_deg;
  }
}

TEST(FlagTest, HangsLimpWithoutBeingStretchedBetweenItsThreads) {
  const auto scene = cloth(kFlagScene);
  const pose::GridSkeleton& grid = grid_of(*scene);
  for (const std::size_t row : {grid.rows / 4, grid.rows / 2, grid.rows - 1}) {
    double way_m = 0.0;
    for (std::size_t column = 0; column + 1 < grid.columns; ++column) {
      way_m += (rest_at(*scene, column + 1, row) - rest_at(*scene, column, row)).length();
    }
    EXPECT_LT(way_m, 1.2 * 1.2) << row;  // its hoist, and as much more as woven cloth gives on the bias
    EXPECT_GT(way_m, 0.9 * 1.2) << row;
  }
}

TEST(BannerTest, ItsArmIsAVane) {
  const auto scene = cloth(kBannerScene);
  const pose::GridSkeleton& grid = grid_of(*scene);
  const auto arm = [&] { return place_at(*scene, grid.columns - 1, 0) - place_at(*scene, 0, 0); };
  for (const double azimuth_deg : {60.0, 200.0, 350.0, 170.0}) {  // the last turns it right about
    blow_on(*scene, cloth_wind(azimuth_deg, 5.0), 600);
    EXPECT_NEAR(arm().x, 0.6 * std::sin(azimuth_deg * kRadPerDeg), 0.01);
    EXPECT_NEAR(arm().z, -0.6 * std::cos(azimuth_deg * kRadPerDeg), 0.01);
    for (std::size_t row = 0; row < grid.rows; ++row) EXPECT_EQ(offset_at(*scene, 0, row).length(), 0.0);
    EXPECT_EQ(arm().y, 0.0);
  }

  // Calm leaves it there, and the cloth hangs from it as it does at rest.
  blow_on(*scene, {}, 1800);
  const Place left = arm();
  EXPECT_NEAR(left.x, 0.6 * std::sin(170.0 * kRadPerDeg), 0.05);
  for (std::size_t row = 0; row < grid.rows; ++row) {
    for (std::size_t column = 0; column < grid.columns; column += 9) {
      const Place from_arm = place_at(*scene, column, row) - place_at(*scene, column, 0);
      EXPECT_NEAR(std::hypot(from_arm.x, from_arm.z), 0.0, 1e-6);
    }
  }
  blow_on(*scene, {}, 60);
  EXPECT_EQ((arm() - left).length(), 0.0);
}

TEST(BannerTest, TheHybridTurnsWithItsArmToo) {
  // The wind blows along the arm wherever it points to, so that the cloth hangs from it alike.
  const auto here = cloth(kBannerScene, {{"hybrid", 1.0}, {"max_flutter", 0.0}});
  const auto there = cloth(kBannerScene, {{"hybrid", 1.0}, {"max_flutter", 0.0}});
  blow_on(*here, cloth_wind(90.0, 6.0), 1200);
  blow_on(*there, cloth_wind(0.0, 6.0), 1200);
  const pose::GridSkeleton& grid = grid_of(*here);
  const Place a = place_at(*here, grid.columns - 1, grid.rows - 1) - place_at(*here, 0, 0);
  const Place b = place_at(*there, grid.columns - 1, grid.rows - 1) - place_at(*there, 0, 0);
  EXPECT_NEAR(b.x, a.z, 0.05);  // a quarter turn back
  EXPECT_NEAR(b.y, a.y, 0.05);
  EXPECT_NEAR(b.z, -a.x, 0.05);
}

}  // namespace
}  // namespace yuragi::scenes
