// What every scene promises (engine/scenes/scene.hpp), on each scene of the table as it is shipped.

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "engine/math/philox.hpp"
#include "engine/pose/kinematics.hpp"
#include "engine/pose/pose_arrays.hpp"
#include "engine/pose/pose_hash.hpp"
#include "engine/scenes/scene.hpp"
#include "tests/support/gusty_wind.hpp"
#include "tests/support/scripted_wind.hpp"

namespace yuragi::scenes {
namespace {

constexpr double kContractTick_s = 1.0 / 60.0;

std::unique_ptr<Scene> make(const Description& kind, const Setup& setup = {.seed = 1}) {
  return kind.make(ParameterValues::resolve(kind.parameters, {}).value(), setup);
}

/// A wind that no sensor and no estimator should give, and any may.
wind::Vector nasty_wind(std::uint64_t tick) {
  const math::RandomStream random(3, math::stream_id("nasty wind"));
  const auto toward = [](double speed_m_s, double azimuth_deg) {
    const double azimuth_rad = azimuth_deg * std::numbers::pi / 180.0;
    return wind::Vector{speed_m_s * std::sin(azimuth_rad), speed_m_s * std::cos(azimuth_rad)};
  };
  switch (tick / 60) {
    case 0:  // out of nothing
      return toward(60.0, 45.0);
    case 1:  // and gone
      return {};
    case 2:  // through north, to and fro
      return toward(20.0, tick / 10 % 2 == 0 ? 350.0 : 10.0);
    case 3:  // reversed in each tick
      return toward(tick % 2 == 0 ? 60.0 : -60.0, 120.0);
    case 4:  // reversed slowly enough to be followed
      return toward(tick / 8 % 2 == 0 ? 40.0 : -40.0, 200.0);
    case 5:  // anything
      return toward(200.0 * random.uniform(2 * tick), 360.0 * random.uniform(2 * tick + 1));
    default:  // beyond all measure
      return toward(1e200, static_cast<double>(tick));
  }
}
constexpr std::uint64_t kNastyTicks = 420;

/// The same with gusts as nasty.
wind::ground::Wind nasty_gusts(std::uint64_t tick) {
  const math::RandomStream random(3, math::stream_id("nasty gusts"));
  wind::ground::Wind wind(nasty_wind(tick));
  for (std::size_t i = 0; i < wind::turbulence::GustNoise::kOctaves; ++i) {
    wind.gusts.along_m_s[i] = static_cast<float>(10.0 * random.uniform(64 * (tick / 7) + i));
    wind.gusts.across_m_s[i] = static_cast<float>(10.0 * random.uniform(64 * (tick / 7) + 32 + i));
  }
  wind.gusts.carried = shared_gusts()->begin(tick / 3);  // and torn from place to place
  wind.advection = nasty_wind(tick + 1);
  wind.tick = tick;
  return wind;
}

std::vector<pose::JointPosition> all_joints(const pose::Kinematics& kinematics, std::size_t count) {
  std::vector<pose::JointPosition> joints;
  joints.reserve(count);
  for (std::size_t i = 0; i < count; ++i) joints.push_back(kinematics.joint(i));
  return joints;
}

/// How far the joint that moved farthest went. NaN where a joint is no place.
double largest_step_m(const std::vector<pose::JointPosition>& from, const std::vector<pose::JointPosition>& to) {
  double largest_square = 0.0;
  for (std::size_t i = 0; i < from.size(); ++i) {
    const double x = static_cast<double>(to[i].x_m) - static_cast<double>(from[i].x_m);
    const double y = static_cast<double>(to[i].y_m) - static_cast<double>(from[i].y_m);
    const double z = static_cast<double>(to[i].z_m) - static_cast<double>(from[i].z_m);
    const double square = x * x + y * y + z * z;
    if (!std::isfinite(square)) return std::nan("");
    largest_square = std::max(largest_square, square);
  }
  return std::sqrt(largest_square);
}

class SceneContract : public testing::TestWithParam<const Description*> {};

INSTANTIATE_TEST_SUITE_P(Scenes, SceneContract, testing::ValuesIn(scene_table().begin(), scene_table().end()),
                         [](const auto& scene) { return std::string(scene.param->name); });

TEST_P(SceneContract, TellsWhatItIs) {
  EXPECT_FALSE(GetParam()->summary.empty());
  for (const Parameter& parameter : GetParam()->parameters) {
    EXPECT_FALSE(parameter.help.empty()) << parameter.name;
    EXPECT_FALSE(describe_allowed(parameter).empty()) << parameter.name;
  }
}

TEST_P(SceneContract, ItsPoseFitsItsSkeletonAndBeginsAtRest) {
  const auto scene = make(*GetParam());
  EXPECT_GT(pose::node_count(scene->skeleton()), 0U);
  EXPECT_TRUE(pose::fits(scene->pose(), scene->skeleton()));
  scene->tick(wind::Vector{3.0, 1.0}, kContractTick_s);
  EXPECT_TRUE(pose::fits(scene->pose(), scene->skeleton()));
}

TEST_P(SceneContract, CalmIsTheRestPoseUnlessItSaysThatItMovesInCalmAirToo) {
  const auto scene = make(*GetParam());
  for (int tick = 0; tick < 120; ++tick) scene->tick(wind::Vector{}, kContractTick_s);
  const pose::Pose rest = pose::rest_pose(scene->skeleton());
  pose::Kinematics at_rest(scene->skeleton());
  pose::Kinematics in_calm(scene->skeleton());
  ASSERT_TRUE(at_rest.run(rest));
  ASSERT_TRUE(in_calm.run(scene->pose()));
  EXPECT_EQ(in_calm.hash(0) == at_rest.hash(0), GetParam()->is_still_in_calm);
}

/// Both kinds of wind: one that is the same everywhere, and one that brings its gusts.
TEST_P(SceneContract, NoWindMovesAJointFartherInATickThanItsBound) {
  for (const bool has_gusts : {false, true}) {
    const double dt_s = has_gusts ? 1.0 / 144.0 : kContractTick_s;
    const auto scene = make(*GetParam(), {.seed = 1, .gusts = has_gusts ? shared_gusts() : nullptr});
    const double bound_m = scene->largest_joint_step_m(dt_s);
    ASSERT_TRUE(std::isfinite(bound_m));
    pose::Kinematics kinematics(scene->skeleton());
    const std::size_t count = pose::node_count(scene->skeleton());
    ASSERT_TRUE(kinematics.run(scene->pose()));
    std::vector<pose::JointPosition> before = all_joints(kinematics, count);
    double largest_m = 0.0;
    for (std::uint64_t tick = 0; tick < kNastyTicks; ++tick) {
      scene->tick(has_gusts ? nasty_gusts(tick) : wind::ground::Wind(nasty_wind(tick)), dt_s);
      ASSERT_TRUE(kinematics.run(scene->pose()));
      std::vector<pose::JointPosition> now = all_joints(kinematics, count);
      const double step_m = largest_step_m(before, now);
      ASSERT_LE(step_m, bound_m * (1.0 + 1e-5) + 1e-5) << "at tick " << tick;  // and with it: finite
      largest_m = std::max(largest_m, step_m);
      before = std::move(now);
    }
    EXPECT_GT(largest_m, 1e-3 * bound_m) << "the bound of " << bound_m << " m says nothing";
    std::printf("%s at %.0f Hz%s: %.4f m a tick at most, bound %.4f m\n", std::string(GetParam()->name).c_str(),
                1.0 / dt_s, has_gusts ? " with gusts" : "", largest_m, bound_m);
  }
}

TEST_P(SceneContract, CalmWithGustsThatHaveNoStrengthIsTheRestPose) {
  const auto scene = make(*GetParam(), {.seed = 1, .gusts = shared_gusts()});
  for (int tick = 0; tick < 60; ++tick) scene->tick(wind::Vector{}, kContractTick_s);
  const pose::Pose rest = pose::rest_pose(scene->skeleton());
  pose::Kinematics at_rest(scene->skeleton());
  pose::Kinematics in_calm(scene->skeleton());
  ASSERT_TRUE(at_rest.run(rest));
  ASSERT_TRUE(in_calm.run(scene->pose()));
  EXPECT_EQ(in_calm.hash(0) == at_rest.hash(0), GetParam()->is_still_in_calm);
}

TEST_P(SceneContract, TheSameSeedAndWindGiveTheSameBitsAndAnotherSeedOthers) {
  const auto run = [](Scene& scene) {
    std::uint64_t hash = pose::kPoseHashSeed;
    for (std::uint64_t tick = 0; tick < 60; ++tick) {
      scene.tick(scripted_wind(tick), kContractTick_s);
      hash = pose::pose_hash(hash, scene.pose());
    }
    return hash;
  };
  const std::uint64_t hash = run(*make(*GetParam()));
  EXPECT_EQ(run(*make(*GetParam())), hash);
  EXPECT_NE(run(*make(*GetParam(), {.seed = 2})), hash);
}

TEST_P(SceneContract, StandsWhereItIsPlaced) {
  const auto here = make(*GetParam());
  const auto there = make(*GetParam(), {.seed = 1, .placement = {100.0, 3.0, -50.0, 90.0}});
  pose::Kinematics here_joints(here->skeleton());
  pose::Kinematics there_joints(there->skeleton());
  ASSERT_TRUE(here_joints.run(here->pose()));
  ASSERT_TRUE(there_joints.run(there->pose()));
  const std::size_t count = pose::node_count(here->skeleton());
  for (std::size_t i = 0; i < count; i += 97) {  // a quarter turn clockwise: north (-z) becomes east (+x)
    const pose::JointPosition a = here_joints.joint(i);
    const pose::JointPosition b = there_joints.joint(i);
    // 100 m off a float is rounded by 4e-6 m, and a leaf stands on the sum of up to 3 x 256 links.
    ASSERT_NEAR(b.x_m, 100.0F - a.z_m, 1e-3F);
    ASSERT_NEAR(b.y_m, 3.0F + a.y_m, 1e-3F);
    ASSERT_NEAR(b.z_m, -50.0F + a.x_m, 1e-3F);
  }
}

}  // namespace
}  // namespace yuragi::scenes
