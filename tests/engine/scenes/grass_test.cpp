#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "engine/base/units.hpp"
#include "engine/pose/strand_kinematics.hpp"
#include "engine/scenes/scene.hpp"
#include "tests/support/bits.hpp"
#include "tests/support/gusty_wind.hpp"
#include "tests/support/scripted_wind.hpp"

namespace yuragi::scenes {

extern const Description kGrassScene;

namespace {

constexpr double kTick_s = 1.0 / 60.0;

std::unique_ptr<Scene> grass(const ParameterValues::Map& given = {}, std::uint64_t seed = 1) {
  return kGrassScene.make(ParameterValues::resolve(kGrassScene.parameters, given).value(), {.seed = seed});
}

/// A meadow of 20 x 20 blades: enough for what each blade must do.
ParameterValues::Map small(ParameterValues::Map also = {}) {
  also["blades_across"] = std::int64_t{20};
  also["blades_deep"] = std::int64_t{20};
  return also;
}

const pose::StrandSkeleton& skeleton_of(const Scene& scene) {
  return std::get<pose::StrandSkeleton>(scene.skeleton());
}
const pose::StrandPose& pose_of(const Scene& scene) {
  return std::get<pose::StrandPose>(scene.pose());
}

double bend_rad(const pose::StrandPose& pose, std::size_t i) {
  return static_cast<double>(std::hypot(pose.bend_east_rad[i], pose.bend_south_rad[i]));
}

/// Where a blade leans to, clockwise from north.
double lean_azimuth_rad(const pose::StrandPose& pose, std::size_t i) {
  return static_cast<double>(std::atan2(pose.bend_east_rad[i], -pose.bend_south_rad[i]));
}

/// The wind that blows toward an azimuth.
wind::Vector toward(double azimuth_rad, double speed_m_s) {
  return {speed_m_s * std::sin(azimuth_rad), speed_m_s * std::cos(azimuth_rad)};
}

void run(Scene& scene, wind::Vector wind, int ticks) {
  for (int i = 0; i < ticks; ++i) scene.tick(wind, kTick_s);
}

pose::JointPositions joints_of(const Scene& scene) {
  pose::JointPositions joints(skeleton_of(scene));
  const pose::StrandKinematicsJob job{.skeleton = &skeleton_of(scene), .pose = &pose_of(scene), .joints = &joints};
  EXPECT_EQ(job.run(), pose::StrandKinematicsJob::Problem::kNone);
  return joints;
}

TEST(GrassTest, IsInTheSceneTable) {
  const auto table = scene_table();
  EXPECT_EQ(std::count(table.begin(), table.end(), &kGrassScene), 1);
}

TEST(GrassTest, HasThePapers100000NodesByDefault) {
  const auto scene = grass();
  EXPECT_EQ(skeleton_of(*scene).strand_count * skeleton_of(*scene).links_per_strand, 100'000U);
}

TEST(GrassTest, StandsInItsRestPoseBeforeTheWindComesAndBitForBitAgainInCalmAir) {
  const auto scene = grass(small());
  const auto rest = bits_of(joints_of(*scene).data());
  run(*scene, {0.0, 0.0}, 10);
  EXPECT_EQ(bits_of(joints_of(*scene).data()), rest);
  run(*scene, toward(1.0, 9.0), 100);
  EXPECT_NE(bits_of(joints_of(*scene).data()), rest);
  run(*scene, {0.0, 0.0}, 1200);  // 20 s, in which what sways comes to rest
  EXPECT_EQ(bits_of(joints_of(*scene).data()), rest);
}

TEST(GrassTest, LinksKeepTheirLengthTo1e5) {
  const auto scene = grass();
  const pose::StrandSkeleton& skeleton = skeleton_of(*scene);
  for (int storm = 0; storm < 5; ++storm) {
    run(*scene, toward(storm, 8.0 * storm), 30);
    const pose::JointPositions joints = joints_of(*scene);
    for (std::size_t i = 0; i < skeleton.strand_count; ++i) {
      pose::JointPosition from{skeleton.root_x_m[i], skeleton.root_y_m[i], skeleton.root_z_m[i]};
      for (std::size_t link = 0; link < skeleton.links_per_strand; ++link) {
        const pose::JointPosition to = joints.joint(i, link);
        const double length_m = std::hypot(static_cast<double>(to.x_m) - static_cast<double>(from.x_m),
                                           static_cast<double>(to.y_m) - static_cast<double>(from.y_m),
                                           static_cast<double>(to.z_m) - static_cast<double>(from.z_m));
        // To 1e-5 of the length, beyond what floats at a place 4 m off can say (a unit in the last place there is 5e-7
        // m).
        EXPECT_NEAR(length_m, skeleton.link_length_m[i], 1e-5 * static_cast<double>(skeleton.link_length_m[i]) + 5e-7);
        from = to;
      }
    }
  }
}

/// No noise: what is left is the answer to the wind.
ParameterValues::Map even(ParameterValues::Map also = {}) {
  also["turbulence"] = 0.0;
  also["gust_strength"] = 0.0;
  return small(also);
}

TEST(GrassTest, DoublingTheWindNeverBendsABladeLess) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    std::vector<double> before(400, 0.0);
    for (const double speed_m_s : {0.5, 1.0, 2.0, 4.0, 8.0, 16.0, 32.0, 64.0}) {
      const auto scene = grass(even(), seed);
      run(*scene, toward(0.3 * speed_m_s, speed_m_s), 600);
      for (std::size_t i = 0; i < before.size(); ++i) {
        const double now = bend_rad(pose_of(*scene), i);
        EXPECT_GE(now, before[i] - 1e-6);
        before[i] = now;
      }
    }
  }
}

TEST(GrassTest, MoreWindBendsTheMeadowMoreUntilItIsBentDown) {
  double before = 0.0;
  for (const double speed_m_s : {1.0, 3.0, 6.0, 12.0, 24.0, 48.0}) {
    const auto scene = grass(small());
    double mean_rad = 0.0;
    for (int tick = 0; tick < 1200; ++tick) {
      scene->tick(toward(0.4, speed_m_s), kTick_s);
      if (tick < 300) continue;
      for (std::size_t i = 0; i < 400; ++i) mean_rad += bend_rad(pose_of(*scene), i) / (400.0 * 900.0);
    }
    EXPECT_GT(mean_rad, before);
    EXPECT_LT(mean_rad, 80.0 * kRadPerDeg);
    before = mean_rad;
  }
}

TEST(GrassTest, LeansToWhereTheWindBlows) {
  for (int azimuth_deg = 0; azimuth_deg < 360; azimuth_deg += 45) {
    const double azimuth_rad = azimuth_deg * kRadPerDeg;
    const auto scene = grass(small());
    const pose::JointPositions rest = joints_of(*scene);
    run(*scene, toward(azimuth_rad, 8.0), 30);
    const pose::JointPositions joints = joints_of(*scene);

    // On average the tips go downwind (x east, z south), and not sideways.
    double downwind_m = 0.0;
    double sideways_m = 0.0;
    for (std::size_t i = 0; i < 400; ++i) {
      const auto x_m = static_cast<double>(joints.joint(i, 9).x_m - rest.joint(i, 9).x_m);
      const auto z_m = static_cast<double>(joints.joint(i, 9).z_m - rest.joint(i, 9).z_m);
      downwind_m += (x_m * std::sin(azimuth_rad) - z_m * std::cos(azimuth_rad)) / 400.0;
      sideways_m += (x_m * std::cos(azimuth_rad) + z_m * std::sin(azimuth_rad)) / 400.0;
    }
    EXPECT_GT(downwind_m, 0.1) << azimuth_deg;
    EXPECT_LT(std::abs(sideways_m), 0.2 * downwind_m) << azimuth_deg;
  }
}

TEST(GrassTest, TurningTheWindTurnsTheLeanByTheSameAngle) {
  const auto scene = grass(even());
  run(*scene, toward(0.4, 6.0), 1200);
  const pose::StrandPose before = pose_of(*scene);
  run(*scene, toward(1.1, 6.0), 1200);
  for (std::size_t i = 0; i < 400; ++i) {
    EXPECT_NEAR(lean_azimuth_rad(pose_of(*scene), i) - lean_azimuth_rad(before, i), 0.7, 1e-4);
    EXPECT_NEAR(bend_rad(pose_of(*scene), i), bend_rad(before, i), 1e-4);
  }
}

TEST(GrassTest, NoWindBendsTheNoisesAnswerBeyondTheLargestBend) {
  const auto scene = grass(small({{"max_bend", 70.0}, {"hybrid", 0.0}}));
  for (const double speed_m_s : {30.0, 120.0, 1e6}) {
    run(*scene, toward(2.0, speed_m_s), 20);
    for (std::size_t i = 0; i < 400; ++i) EXPECT_LE(bend_rad(pose_of(*scene), i), 70.0 * kRadPerDeg + 1e-6);
  }
}

TEST(GrassTest, BladesSwayOnAfterAGustWhereTheyAreOscillators) {
  const auto noise = grass(even({{"hybrid", 0.0}}));
  const auto hybrid = grass(even({{"hybrid", 1.0}}));
  const auto turns = [](Scene& scene) {  // how often a blade changes between going and coming back
    run(scene, toward(0.0, 9.0), 600);
    int count = 0;
    double before = bend_rad(pose_of(scene), 0);
    double step = 0.0;
    for (int tick = 0; tick < 120; ++tick) {
      scene.tick(toward(0.0, 3.0), kTick_s);
      const double now = bend_rad(pose_of(scene), 0);
      if ((now - before) * step < -1e-12) ++count;
      step = now - before;
      before = now;
    }
    return count;
  };
  EXPECT_EQ(turns(*noise), 0);
  EXPECT_GE(turns(*hybrid), 4);
}

TEST(GrassTest, StandsWhereItIsPlacedAndTurned) {
  const auto here = grass(even());
  const auto there = kGrassScene.make(ParameterValues::resolve(kGrassScene.parameters, even()).value(),
                                      {.seed = 1, .placement = {10.0, 2.0, -5.0, 90.0}});
  const pose::StrandSkeleton& a = skeleton_of(*here);
  const pose::StrandSkeleton& b = skeleton_of(*there);
  for (std::size_t i = 0; i < a.strand_count; ++i) {  // what was to the north (-z) is now to the east (+x)
    EXPECT_NEAR(b.root_x_m[i], 10.0F - a.root_z_m[i], 1e-5F);
    EXPECT_NEAR(b.root_y_m[i], 2.0F, 1e-6F);
    EXPECT_NEAR(b.root_z_m[i], -5.0F + a.root_x_m[i], 1e-5F);
    EXPECT_NEAR(b.rest_x[i], -a.rest_z[i], 1e-6F);
    EXPECT_NEAR(b.curl_z[i], a.curl_x[i], 1e-6F);
  }
  // The wind is the world's, wherever the scene points to.
  run(*there, toward(0.4, 6.0), 1200);
  EXPECT_NEAR(lean_azimuth_rad(pose_of(*there), 7), 0.4, 1e-4);
}

TEST(GrassTest, BladesDifferAsTheWindOnTheGroundDoes) {
  const auto still = grass(small({{"turbulence", 0.0}, {"gust_strength", 0.0}, {"blade_length_variation", 0.0}}));
  const auto lively = grass(small());
  run(*still, toward(1.0, 7.0), 10);
  run(*lively, toward(1.0, 7.0), 10);
  const auto spread = [](const Scene& scene) {
    double least = 10.0;
    double most = 0.0;
    for (std::size_t i = 0; i < 400; ++i) {
      least = std::min(least, bend_rad(pose_of(scene), i));
      most = std::max(most, bend_rad(pose_of(scene), i));
    }
    return most - least;
  };
  EXPECT_GT(spread(*lively), spread(*still));
}

TEST(GrassTest, GustsComeAndGoInASteadyWind) {
  const auto scene = grass(small({{"turbulence", 0.0}}));
  double least = 10.0;
  double most = 0.0;
  for (int tick = 0; tick < 3000; ++tick) {
    run(*scene, toward(1.0, 7.0), 1);
    least = std::min(least, bend_rad(pose_of(*scene), 0));
    most = std::max(most, bend_rad(pose_of(*scene), 0));
  }
  EXPECT_GT(most, 1.1 * least);
}

TEST(GrassTest, TheSameSeedAndWindGiveTheSameBitsAndAnotherSeedOthers) {
  const auto scene = grass(small(), 1);
  const auto same = grass(small(), 1);
  const auto other = grass(small(), 2);
  for (std::uint64_t tick = 0; tick < 100; ++tick) {
    for (Scene* each : {scene.get(), same.get(), other.get()}) each->tick(scripted_wind(tick), kTick_s);
  }
  EXPECT_EQ(bits_of(joints_of(*scene).data()), bits_of(joints_of(*same).data()));
  EXPECT_NE(bits_of(joints_of(*scene).data()), bits_of(joints_of(*other).data()));
}

TEST(GrassTest, TakesBothMeaningsOfBeta) {
  const auto transect = grass(small({{"beta_meaning", std::string("transect")}}));
  const auto radial = grass(small({{"beta_meaning", std::string("radial")}}));
  run(*transect, toward(1.0, 7.0), 10);
  run(*radial, toward(1.0, 7.0), 10);
  EXPECT_NE(bits_of(pose_of(*transect).bend_east_rad), bits_of(pose_of(*radial).bend_east_rad));
}

TEST(GrassTest, AMillionNodesWork) {
  const auto scene = grass({{"blades_across", std::int64_t{400}}, {"blades_deep", std::int64_t{250}}});
  EXPECT_EQ(skeleton_of(*scene).strand_count * skeleton_of(*scene).links_per_strand, 1'000'000U);
  run(*scene, toward(1.0, 10.0), 3);
  const pose::JointPositions joints = joints_of(*scene);
  for (const float coordinate : joints.data()) ASSERT_TRUE(std::isfinite(coordinate));
}

/// A long, thin meadow along x in a gusty west wind; the bend toward east of each of its rows of blades, tick by tick.
std::vector<std::vector<double>> rows_in_gusts(double wind_m_s, int ticks) {
  const auto values = ParameterValues::resolve(kGrassScene.parameters, {{"blades_across", std::int64_t{16}},
                                                                        {"blades_deep", std::int64_t{4}},
                                                                        {"width", 24.0},
                                                                        {"depth", 1.0},
                                                                        {"hybrid", 0.0}})
                          .value();
  const auto scene = kGrassScene.make(values, {.seed = 1, .gusts = shared_gusts()});
  const pose::StrandSkeleton& skeleton = skeleton_of(*scene);
  GustyWind wind({wind_m_s, 0.0}, 0.35F);
  std::vector<std::vector<double>> rows(2);
  for (int tick = 0; tick < ticks; ++tick) {
    scene->tick(wind.step(kTick_s), kTick_s);
    std::array<double, 2> sums{};
    for (std::size_t i = 0; i < skeleton.strand_count; ++i) {
      const double x_m = static_cast<double>(skeleton.root_x_m[i]);
      if (std::abs(x_m + 9.0) < 1.5) sums[0] += bend_rad(pose_of(*scene), i);
      if (std::abs(x_m - 9.0) < 1.5) sums[1] += bend_rad(pose_of(*scene), i);
    }
    for (std::size_t row = 0; row < 2; ++row) rows[row].push_back(sums[row]);
  }
  return rows;
}

/// The correlation of `a` with `b`, which comes `lag` ticks later.
double correlation(const std::vector<double>& a, const std::vector<double>& b, std::size_t lag) {
  const std::size_t count = a.size() - lag;
  double mean_a = 0.0;
  double mean_b = 0.0;
  for (std::size_t i = 0; i < count; ++i) {
    mean_a += a[i] / static_cast<double>(count);
    mean_b += b[i + lag] / static_cast<double>(count);
  }
  double both = 0.0;
  double squares_a = 0.0;
  double squares_b = 0.0;
  for (std::size_t i = 0; i < count; ++i) {
    both += (a[i] - mean_a) * (b[i + lag] - mean_b);
    squares_a += (a[i] - mean_a) * (a[i] - mean_a);
    squares_b += (b[i + lag] - mean_b) * (b[i + lag] - mean_b);
  }
  return both / std::sqrt(squares_a * squares_b);
}

TEST(GrassTest, AGustFromOutsideTravelsOverTheMeadowAsFastAsTheWind) {
  const double wind_m_s = 6.0;
  const auto rows = rows_in_gusts(wind_m_s, 60 * 120);
  std::size_t best = 0;
  for (std::size_t lag = 0; lag < 60 * 8; ++lag) {
    if (correlation(rows[0], rows[1], lag) > correlation(rows[0], rows[1], best)) best = lag;
  }
  EXPECT_NEAR(kTick_s * static_cast<double>(best), 18.0 / wind_m_s, 0.3);
  EXPECT_GT(correlation(rows[0], rows[1], best), 0.8);
  EXPECT_LT(correlation(rows[0], rows[1], 0), 0.6) << "rows 18 m apart feel other gusts at the same moment";
}

}  // namespace
}  // namespace yuragi::scenes
