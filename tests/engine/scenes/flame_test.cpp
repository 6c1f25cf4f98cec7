#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "engine/pose/point_kinematics.hpp"
#include "engine/pose/pose_arrays.hpp"
#include "engine/pose/pose_hash.hpp"
#include "engine/scenes/scene.hpp"
#include "tests/support/each_simd_row.hpp"
#include "tests/support/scripted_wind.hpp"

namespace yuragi::scenes {

extern const Description kFlameScene;

namespace {

constexpr double kFlameTick_s = 1.0 / 60.0;

std::unique_ptr<Scene> flame(const std::string& form, ParameterValues::Map given = {},
                             const Setup& setup = {.seed = 1}) {
  given["form"] = form;
  given.try_emplace("columns", std::int64_t{48});
  given.try_emplace("rows", std::int64_t{40});
  return kFlameScene.make(ParameterValues::resolve(kFlameScene.parameters, given).value(), setup);
}

const pose::SurfaceSkeleton& body_of(const Scene& scene) {
  return std::get<pose::SurfaceSkeleton>(scene.skeleton());
}
const pose::SurfacePose& flame_pose_of(const Scene& scene) {
  return std::get<pose::SurfacePose>(scene.pose());
}

void run_flame(Scene& scene, wind::Vector wind, int ticks) {
  for (int i = 0; i < ticks; ++i) scene.tick(wind, kFlameTick_s);
}

/// Where the heat is: its center, above the foot, and how much there is of it, a point on average.
struct Heat {
  double east_m, up_m, south_m, mean;
};
Heat heat_of(const Scene& scene) {
  pose::PointPositions points(body_of(scene));
  const pose::SurfaceKinematicsJob job{.skeleton = &body_of(scene), .pose = &flame_pose_of(scene), .points = &points};
  EXPECT_EQ(job.run(), pose::SurfaceKinematicsJob::Problem::kNone);
  Heat heat{};
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto here = static_cast<double>(flame_pose_of(scene).heat[i]);
    const pose::JointPosition at = points.point(i);
    heat.east_m += here * static_cast<double>(at.x_m);
    heat.up_m += here * static_cast<double>(at.y_m);
    heat.south_m += here * static_cast<double>(at.z_m);
    heat.mean += here;
  }
  const double foot_m = static_cast<double>(std::get<pose::SurfaceSkeleton>(scene.skeleton()).rest_y_m.front());
  return {heat.east_m / heat.mean, heat.up_m / heat.mean - foot_m, heat.south_m / heat.mean,
          heat.mean / static_cast<double>(points.size())};
}

/// The mean of it over twenty seconds of a wind.
Heat mean_heat(Scene& scene, wind::Vector wind) {
  run_flame(scene, wind, 180);
  Heat mean{};
  for (int i = 0; i < 80; ++i) {
    run_flame(scene, wind, 15);
    const Heat now = heat_of(scene);
    mean = {mean.east_m + now.east_m / 80.0, mean.up_m + now.up_m / 80.0, mean.south_m + now.south_m / 80.0,
            mean.mean + now.mean / 80.0};
  }
  return mean;
}

class FlameForms : public testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(Forms, FlameForms, testing::Values("texture", "shape"),
                         [](const auto& form) { return form.param; });

TEST_P(FlameForms, IsUnlitAndUprightAtRestAndThenCatchesFireWithoutAJump) {
  const auto scene = flame(GetParam());
  EXPECT_EQ(pose::pose_hash(0, scene->pose()), pose::pose_hash(0, pose::rest_pose(scene->skeleton())));
  std::vector<float> before = flame_pose_of(*scene).heat;
  double total = 0.0;
  for (int tick = 0; tick < 180; ++tick) {
    run_flame(*scene, {}, 1);
    const std::vector<float>& now = flame_pose_of(*scene).heat;
    double step = 0.0;
    total = 0.0;
    for (std::size_t i = 0; i < now.size(); ++i) {
      step += static_cast<double>(std::abs(now[i] - before[i])) / static_cast<double>(now.size());
      total += static_cast<double>(now[i]) / static_cast<double>(now.size());
    }
    ASSERT_LT(step, 0.1);  // as it flickers when it burns, and no more
    before = now;
  }
  EXPECT_GT(total, 0.02);
  EXPECT_FALSE(kFlameScene.is_still_in_calm);
}

TEST_P(FlameForms, HeatIsFromNoneToFullAndDiesOutTowardTheTop) {
  const auto scene = flame(GetParam());
  run_flame(*scene, {}, 180);
  const pose::SurfaceSkeleton& body = body_of(*scene);
  std::vector<double> of_row(body.rows, 0.0);
  for (int moment = 0; moment < 100; ++moment) {
    run_flame(*scene, {}, 12);
    for (std::size_t i = 0; i < flame_pose_of(*scene).heat.size(); ++i) {
      const float heat = flame_pose_of(*scene).heat[i];
      ASSERT_GE(heat, 0.0F);
      ASSERT_LE(heat, 1.0F);
      of_row[i / body.columns] += static_cast<double>(heat);
    }
  }
  for (std::size_t row = 5; row < body.rows; row += 5) {
    EXPECT_LT(of_row[row], of_row[row - 5] + 1e-9) << row;
  }
  EXPECT_GT(of_row[0], 0.0);
  EXPECT_LT(of_row[body.rows - 1], 0.1 * of_row[0]);
}

TEST_P(FlameForms, ItsTonguesRise) {
  // What the heat is like now, some rows up, is most like what it was a moment ago lower down.
  const auto scene = flame(GetParam(), {{"rows", std::int64_t{80}}});
  run_flame(*scene, {}, 180);
  const std::size_t columns = body_of(*scene).columns;
  double up = 0.0;
  double down = 0.0;
  for (int moment = 0; moment < 100; ++moment) {
    const std::vector<float> before = flame_pose_of(*scene).heat;
    run_flame(*scene, {}, 2);  // 8 cm in 1/30 s at 2.5 m/s: five rows of the body, and four of the panel
    const std::vector<float>& now = flame_pose_of(*scene).heat;
    for (std::size_t row = 10; row < 50; ++row) {
      for (std::size_t column = 0; column < columns; ++column) {
        const auto at = [&](const std::vector<float>& heat, std::size_t r) {
          // against its own mean over the neighbourhood, so that the ramp itself does not count
          return static_cast<double>(heat[r * columns + column]) -
                 0.5 * static_cast<double>(heat[(r - 8) * columns + column] + heat[(r + 8) * columns + column]);
        };
        up += at(before, row) * at(now, row + 5);
        down += at(before, row + 5) * at(now, row);
      }
    }
  }
  EXPECT_GT(up, 0.0);
  EXPECT_GT(up, 2.0 * down);
}

double tilt_rad(const Heat& heat) {
  return std::atan2(heat.east_m, heat.up_m);
}

TEST_P(FlameForms, StandsUprightInCalmAirAndLeansFurtherTheMoreItBlows) {
  EXPECT_LT(std::abs(mean_heat(*flame(GetParam()), {}).east_m), 0.04);  // the noise itself strays so far
  double before_rad = 0.1;
  for (const double speed_m_s : {1.0, 3.0, 8.0, 30.0}) {
    const Heat heat = mean_heat(*flame(GetParam()), {speed_m_s, 0.0});
    EXPECT_GT(tilt_rad(heat), before_rad) << speed_m_s;
    EXPECT_NEAR(heat.south_m, 0.0, 0.04);
    before_rad = tilt_rad(heat);
  }
  EXPECT_LT(tilt_rad(mean_heat(*flame(GetParam()), {60.0, 0.0})), std::numbers::pi / 2.0) << "no storm lays it flat";

  // Where less of the wind reaches it, it leans less; where nothing does, not at all.
  const Heat sheltered = mean_heat(*flame(GetParam(), {{"exposure", 0.3}}), {8.0, 0.0});
  EXPECT_LT(tilt_rad(sheltered), tilt_rad(mean_heat(*flame(GetParam()), {3.0, 0.0})));
  EXPECT_LT(std::abs(mean_heat(*flame(GetParam(), {{"exposure", 0.0}}), {8.0, 0.0}).east_m), 0.04);
}

TEST_P(FlameForms, BreathesTwiceASecondAndTheLessTheMoreItBlows) {
  // The whole heat by 1.5 / sqrt(0.5 m) = 2.12 Hz, against frequencies beside it; 40 s, by Hann's window.
  const auto breath = [](const std::string& form, double puffing, wind::Vector wind, double hz) {
    const auto scene = flame(form, {{"puffing", puffing}});
    run_flame(*scene, wind, 300);
    double cosine = 0.0;
    double sine = 0.0;
    double total = 0.0;
    for (int tick = 0; tick < 2400; ++tick) {
      run_flame(*scene, wind, 1);
      const double heat = heat_of(*scene).mean;
      const double weight = 1.0 - std::cos(2.0 * std::numbers::pi * tick / 2400.0);
      cosine += weight * heat * std::cos(2.0 * std::numbers::pi * hz * tick / 60.0);
      sine += weight * heat * std::sin(2.0 * std::numbers::pi * hz * tick / 60.0);
      total += weight * heat;
    }
    return std::hypot(cosine, sine) / total;
  };
  const auto strongest = [&](double puffing, wind::Vector wind, double from_hz) {
    double most = 0.0;
    for (int i = 0; i < 16; ++i) most = std::max(most, breath(GetParam(), puffing, wind, from_hz + 0.025 * i));
    return most;
  };
  const double still = strongest(0.13, {}, 1.95);
  EXPECT_GT(still, 3.0 * strongest(0.13, {}, 1.0));
  EXPECT_GT(still, 3.0 * strongest(0.13, {}, 3.0));
  EXPECT_GT(still, 3.0 * strongest(0.0, {}, 1.95));
  EXPECT_LT(strongest(0.13, {30.0, 0.0}, 1.95), 0.5 * still);
}

TEST(FlameTest, ItsInnerShellsAreHotterAndNarrower) {
  const auto scene = flame("shape");
  const pose::SurfaceSkeleton& body = body_of(*scene);
  ASSERT_EQ(body.shells, 3U);
  const std::size_t around = body.columns / 3;
  std::array<double, 3> heat{};
  for (int moment = 0; moment < 40; ++moment) {
    run_flame(*scene, {5.0, 0.0}, 15);
    for (std::size_t i = 0; i < body.columns * body.rows / 2; ++i) {
      heat[i % body.columns / around] += static_cast<double>(flame_pose_of(*scene).heat[i]);
    }
  }
  EXPECT_GT(heat[1], 1.1 * heat[0]);
  EXPECT_GT(heat[2], 1.1 * heat[1]);
  const std::size_t middle = body.rows / 3 * body.columns;
  for (std::size_t shell = 1; shell < 3; ++shell) {
    const double part =
        static_cast<double>(std::hypot(body.rest_x_m[middle + shell * around], body.rest_z_m[middle + shell * around]) /
                            std::hypot(body.rest_x_m[middle], body.rest_z_m[middle]));
    EXPECT_NEAR(part, shell == 1 ? 0.65 : 0.35, 1e-5);
  }
}

TEST(FlameTest, ItDoesNotRepeat) {
  // The heat of a few places of the outermost shell, every tenth of a second for ten minutes: no later stretch of it is
  // like the first four seconds.
  const auto scene = flame("shape", {{"puffing", 0.0}});
  run_flame(*scene, {}, 300);
  const std::size_t columns = body_of(*scene).columns;
  std::vector<std::array<double, 6>> heats;
  std::array<double, 6> mean{};
  for (int moment = 0; moment < 6000; ++moment) {
    run_flame(*scene, {}, 6);
    std::array<double, 6>& now = heats.emplace_back();
    for (std::size_t i = 0; i < 6; ++i) {
      now[i] = static_cast<double>(flame_pose_of(*scene).heat[(18 + i / 3 * 6) * columns + i % 3 * 5]);
      mean[i] += now[i] / 6000.0;
    }
  }
  const auto likeness = [&](std::size_t lag) {
    double both = 0.0;
    double first = 0.0;
    double second = 0.0;
    for (std::size_t moment = 0; moment < 40; ++moment) {
      for (std::size_t i = 0; i < 6; ++i) {
        const double a = heats[moment][i] - mean[i];
        const double b = heats[moment + lag][i] - mean[i];
        both += a * b;
        first += a * a;
        second += b * b;
      }
    }
    return both / std::sqrt(first * second);
  };
  for (std::size_t lag = 10; lag + 40 < heats.size(); ++lag)
    ASSERT_LT(likeness(lag), 0.75) << "after " << 0.1 * static_cast<double>(lag) << " s";
}

TEST(FlameTest, ATurnedWindTurnsTheLeanOfTheShape) {
  for (int quarter = 0; quarter < 4; ++quarter) {
    const double azimuth_rad = quarter * std::numbers::pi / 2.0;
    const Heat heat = mean_heat(*flame("shape"), {12.0 * std::sin(azimuth_rad), 12.0 * std::cos(azimuth_rad)});
    const double downwind_m = heat.east_m * std::sin(azimuth_rad) - heat.south_m * std::cos(azimuth_rad);
    const double sideways_m = heat.east_m * std::cos(azimuth_rad) + heat.south_m * std::sin(azimuth_rad);
    EXPECT_GT(downwind_m, 0.04) << quarter;
    EXPECT_LT(std::abs(sideways_m), 0.04) << quarter;
  }
}

TEST(FlameTest, APanelDoesNotMoveAndFeelsOnlyTheWindAlongIt) {
  const auto scene = flame("texture");
  EXPECT_EQ(scene->largest_joint_step_m(kFlameTick_s), 0.0);
  const auto across = flame("texture");
  const auto calm = flame("texture");
  for (int tick = 0; tick < 200; ++tick) {
    scene->tick(scripted_wind(static_cast<std::uint64_t>(tick)), kFlameTick_s);
    across->tick(wind::Vector{0.0, 20.0}, kFlameTick_s);
    calm->tick(wind::Vector{}, kFlameTick_s);
    for (const float moved_m : flame_pose_of(*scene).displacement_m) ASSERT_EQ(moved_m, 0.0F);
  }
  EXPECT_EQ(pose::pose_hash(0, across->pose()), pose::pose_hash(0, calm->pose()));

  // Turned by a quarter, the panel stands from north to south: that wind is along it.
  const auto turned = flame("texture", {}, {.seed = 1, .placement = {.heading_deg = 90.0}});
  const Heat heat = mean_heat(*turned, {0.0, 20.0});
  EXPECT_LT(heat.south_m, -0.08);
  EXPECT_NEAR(heat.east_m, 0.0, 1e-6);
}

TEST(FlameTest, ABodyIsClosedRoundAndTaperedAndItsNormalsPointOut) {
  const auto scene = flame("shape");
  const pose::SurfaceSkeleton& body = body_of(*scene);
  EXPECT_TRUE(body.is_closed);
  EXPECT_EQ(body.ramp_rgba.size(), 1024U);
  double widest_m = 0.0;
  for (std::size_t i = 0; i < body.rest_x_m.size(); ++i) {
    const double radius_m = static_cast<double>(std::hypot(body.rest_x_m[i], body.rest_z_m[i]));
    widest_m = std::max(widest_m, radius_m);
    EXPECT_NEAR(std::hypot(body.normal_x[i], body.normal_y[i], body.normal_z[i]), 1.0F, 1e-5F);
    EXPECT_GE(body.normal_x[i] * body.rest_x_m[i] + body.normal_z[i] * body.rest_z_m[i], -1e-6F);
    if (i / body.columns == 0 || i / body.columns + 1 == body.rows) {
      EXPECT_NEAR(radius_m, 0.0, 1e-6);
    }
  }
  EXPECT_NEAR(widest_m, 0.25, 0.003);
}

TEST(FlameTest, ABodyHasNoSeamWhereItCloses) {
  // Between the last column and the first, heat differs no more than between any two neighbours.
  const auto scene = flame("shape");
  run_flame(*scene, {}, 180);
  const std::size_t columns = body_of(*scene).columns;
  const std::size_t around = columns / body_of(*scene).shells;
  std::vector<double> jump(around, 0.0);
  for (int moment = 0; moment < 60; ++moment) {
    run_flame(*scene, {}, 15);
    const std::vector<float>& heat = flame_pose_of(*scene).heat;
    for (std::size_t i = 0; i < heat.size(); ++i) {
      const std::size_t next = i % around + 1 == around ? i + 1 - around : i + 1;
      const auto step = static_cast<double>(heat[next] - heat[i]);
      jump[i % around] += step * step;
    }
  }
  const double seam = jump.back();
  jump.pop_back();
  EXPECT_LT(seam, *std::max_element(jump.begin(), jump.end()));
}

TEST(FlameTest, APointIsNeverMovedThroughTheAxis) {
  const auto scene = flame("shape", {{"flicker", 0.8}});
  const pose::SurfaceSkeleton& body = body_of(*scene);
  for (std::uint64_t tick = 0; tick < 300; ++tick) {
    scene->tick(5.0 * scripted_wind(tick), kFlameTick_s);
    for (std::size_t i = 0; i < body.rest_x_m.size(); ++i) {
      ASSERT_GE(flame_pose_of(*scene).displacement_m[i], -std::hypot(body.rest_x_m[i], body.rest_z_m[i]));
    }
  }
}

TEST(FlameTest, HeatGoesOnWithoutAJumpWhateverTheWindDoes) {
  // In a tenth of the time it changes about a tenth as much. (The wind reverses each quarter of a second, and the panel
  // shows a flame that lies now to the left, now to the right.)
  const auto largest_heat_step = [](const std::string& form, int ticks_per_s) {
    const auto scene = flame(form);
    float largest = 0.0F;
    std::vector<float> before = flame_pose_of(*scene).heat;
    for (int tick = 0; tick < 4 * ticks_per_s; ++tick) {
      scene->tick(wind::Vector{tick * 4 / ticks_per_s % 2 == 0 ? 40.0 : -40.0, 5.0}, 1.0 / ticks_per_s);
      const std::vector<float>& now = flame_pose_of(*scene).heat;
      for (std::size_t i = 0; i < now.size(); ++i) largest = std::max(largest, std::abs(now[i] - before[i]));
      before = now;
    }
    return largest;
  };
  for (const std::string form : {"texture", "shape"}) {
    const float at_60_hz = largest_heat_step(form, 60);
    EXPECT_LT(at_60_hz, form == "texture" ? 0.8F : 0.6F) << form;
    EXPECT_LT(largest_heat_step(form, 600), 0.2F * at_60_hz) << form;
  }
}

class FlameOnEachRow : public EachSimdRow {};
YURAGI_ON_EACH_ROW(FlameOnEachRow);

TEST_P(FlameOnEachRow, BurnsTheSameBitForBit) {
  for (const std::string form : {"texture", "shape"}) {
    const auto base = flame(form, {}, {.seed = 3, .row = kBaseSimdRow});
    const auto scene = flame(form, {}, {.seed = 3, .row = GetParam()});
    for (std::uint64_t tick = 0; tick < 200; ++tick) {
      base->tick(scripted_wind(tick), kFlameTick_s);
      scene->tick(scripted_wind(tick), kFlameTick_s);
      ASSERT_EQ(pose::pose_hash(0, scene->pose()), pose::pose_hash(0, base->pose())) << form;
    }
  }
}

}  // namespace
}  // namespace yuragi::scenes
