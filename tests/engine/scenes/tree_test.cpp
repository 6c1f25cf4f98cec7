#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "engine/base/units.hpp"
#include "engine/pose/pose_arrays.hpp"
#include "engine/pose/pose_hash.hpp"
#include "engine/pose/tree_kinematics.hpp"
#include "engine/scenes/scene.hpp"
#include "engine/scenes/tree_model.hpp"
#include "engine/scenes/tree_species.hpp"
#include "tests/support/gusty_wind.hpp"
#include "tests/support/scripted_wind.hpp"

namespace yuragi::scenes {

extern const Description kTreeScene;

namespace {

constexpr double kTreeTick_s = 1.0 / 60.0;

std::unique_ptr<Scene> tree_scene(const ParameterValues::Map& given = {}, const Setup& setup = {.seed = 1}) {
  return kTreeScene.make(ParameterValues::resolve(kTreeScene.parameters, given).value(), setup);
}

/// A tree that is quick to compute, of a species.
ParameterValues::Map little(std::string_view species = "cherry", ParameterValues::Map also = {}) {
  also["species"] = std::string(species);
  also["limbs"] = std::int64_t{8};
  also["twigs"] = std::int64_t{64};
  also["leaves"] = std::int64_t{1600};
  also["branch_links"] = std::int64_t{16};
  return also;
}

/// No noise: what is left is the answer to the wind.
ParameterValues::Map without_noise(ParameterValues::Map also = {}) {
  also["turbulence"] = 0.0;
  also["crown_gusts"] = 0.0;
  also["leaf_flutter"] = 0.0;
  return little("cherry", also);
}

const pose::TreeSkeleton& tree_of(const Scene& scene) {
  return std::get<pose::TreeSkeleton>(scene.skeleton());
}
const pose::StrandPose& bends_of(const Scene& scene, std::size_t part) {
  return std::get<pose::TreePose>(scene.pose()).levels[part];
}
double bend_of(const Scene& scene, std::size_t part, std::size_t strand) {
  const pose::StrandPose& bends = bends_of(scene, part);
  return static_cast<double>(std::hypot(bends.bend_east_rad[strand], bends.bend_south_rad[strand]));
}

pose::TreeJoints tree_joints(const Scene& scene) {
  pose::TreeJoints joints(tree_of(scene));
  const pose::TreeKinematicsJob job{
      .skeleton = &tree_of(scene), .pose = &std::get<pose::TreePose>(scene.pose()), .joints = &joints};
  EXPECT_EQ(job.run(), pose::TreeKinematicsJob::Problem::kNone);
  return joints;
}

wind::Vector blowing_toward(double azimuth_rad, double speed_m_s) {
  return {speed_m_s * std::sin(azimuth_rad), speed_m_s * std::cos(azimuth_rad)};
}

void blow_on_tree(Scene& scene, wind::Vector wind, int ticks) {
  for (int i = 0; i < ticks; ++i) scene.tick(wind, kTreeTick_s);
}

double crossings_per_s(Scene& scene, std::size_t part, wind::Vector wind);

/// Mean and variance of a number as it comes.
struct Moments {
  void add(double value) {
    ++count;
    const double off = value - mean;
    mean += off / count;
    squares += off * (value - mean);
  }
  double variance() const { return squares / count; }

  double count = 0.0;
  double mean = 0.0;
  double squares = 0.0;
};

TEST(TreeTest, IsInTheSceneTable) {
  const auto table = scene_table();
  EXPECT_EQ(std::count(table.begin(), table.end(), &kTreeScene), 1);
}

TEST(TreeTest, ItsFoliageIsGreenUnlessAskedFor) {
  EXPECT_EQ(tree_of(*tree_scene(little())).foliage, pose::FoliageColor::kGreen);
  for (std::size_t i = 0; i < pose::kFoliageColorNames.size(); ++i) {
    const auto scene = tree_scene(little("cherry", {{"foliage", std::string(pose::kFoliageColorNames[i])}}));
    EXPECT_EQ(tree_of(*scene).foliage, static_cast<pose::FoliageColor>(i));
  }
}

TEST(TreeTest, AGroveIsPlacedWithItsTreeAndMovesNothing) {
  EXPECT_TRUE(tree_of(*tree_scene(little())).copies.x_m.empty());
  const ParameterValues::Map grove = little("cherry", {{"grove", std::int64_t{7}}, {"grove_radius", 25.0}});
  const auto here = tree_scene(grove);
  const auto there = tree_scene(grove, {.seed = 1, .placement = {.x_m = 100.0, .z_m = -50.0, .heading_deg = 90.0}});
  ASSERT_EQ(tree_of(*here).copies.x_m.size(), 6U);
  for (std::size_t i = 0; i < 6; ++i) {
    EXPECT_NEAR(tree_of(*there).copies.x_m[i], 100.0F - tree_of(*here).copies.z_m[i], 1e-4F);
    EXPECT_NEAR(tree_of(*there).copies.z_m[i], -50.0F + tree_of(*here).copies.x_m[i], 1e-4F);
  }
  EXPECT_EQ(pose::node_count(here->skeleton()), pose::node_count(tree_scene(little())->skeleton()));
}

TEST(TreeTest, HasThePapers105536NodesByDefaultWhateverItsSpecies) {
  for (const std::string_view species : kTreeSpeciesNames) {
    EXPECT_EQ(pose::node_count(tree_scene({{"species", std::string(species)}})->skeleton()), 105'536U);
  }
}

TEST(TreeTest, ComesToRestBitForBitWhenTheWindHasGone) {
  const auto scene = tree_scene(little());
  const std::uint64_t rest = pose::pose_hash(0, tree_joints(*scene).level(kLeaves).data());
  blow_on_tree(*scene, blowing_toward(1.0, 12.0), 120);
  EXPECT_NE(pose::pose_hash(0, tree_joints(*scene).level(kLeaves).data()), rest);
  blow_on_tree(*scene, {}, 60 * 90);  // the trunk sways on for long
  EXPECT_EQ(pose::pose_hash(0, tree_joints(*scene).level(kLeaves).data()), rest);
}

TEST(TreeTest, MoreWindBendsEveryPartMoreAndNoWindBeyondTheLargest) {
  std::array<double, kTreePartCount> before = {};
  for (const double speed_m_s : {1.0, 3.0, 6.0, 12.0, 24.0, 48.0}) {
    const auto scene = tree_scene(little("zelkova", {{"hybrid", 0.0}}));
    std::array<Moments, kTreePartCount> bend_rad;
    for (int tick = 0; tick < 1200; ++tick) {
      scene->tick(blowing_toward(0.4, speed_m_s), kTreeTick_s);
      if (tick < 120) continue;
      for (std::size_t part = 0; part < kTreePartCount; ++part) {
        const std::size_t count = tree_of(*scene).levels[part].strands.strand_count;
        for (std::size_t s = 0; s < count; s += 1 + count / 50) bend_rad[part].add(bend_of(*scene, part, s));
      }
      for (std::size_t s = 0; s < 64; ++s)
        ASSERT_LE(bend_of(*scene, kTwigs, s), std::numbers::sqrt2 * 60.0 * kRadPerDeg);
    }
    for (std::size_t part = 0; part < kTreePartCount; ++part) {
      EXPECT_GT(bend_rad[part].mean, before[part]) << part << " at " << speed_m_s << " m/s";
      before[part] = bend_rad[part].mean;
    }
  }
}

TEST(TreeTest, ATurnedTreeInATurnedWindBendsTheSameTurned) {
  const auto scene = tree_scene(without_noise());
  const auto turned = tree_scene(without_noise(), {.seed = 1, .placement = {5.0, 0.0, -7.0, 40.0}});
  blow_on_tree(*scene, blowing_toward(0.4, 9.0), 300);
  blow_on_tree(*turned, blowing_toward(0.4 + 40.0 * kRadPerDeg, 9.0), 300);
  const double cosine = std::cos(40.0 * kRadPerDeg);
  const double sine = std::sin(40.0 * kRadPerDeg);
  for (std::size_t part = 0; part < kTreePartCount; ++part) {
    for (std::size_t s = 0; s < tree_of(*scene).levels[part].strands.strand_count; ++s) {
      const auto east = static_cast<double>(bends_of(*scene, part).bend_east_rad[s]);
      const auto south = static_cast<double>(bends_of(*scene, part).bend_south_rad[s]);
      EXPECT_NEAR(bends_of(*turned, part).bend_east_rad[s], cosine * east - sine * south, 2e-5);
      EXPECT_NEAR(bends_of(*turned, part).bend_south_rad[s], sine * east + cosine * south, 2e-5);
    }
  }
}

TEST(TreeTest, WoodBendsAsTheDragOfACrownThatGivesWay) {
  const auto trunk_deg = [](double speed_m_s) {
    const auto scene = tree_scene(without_noise());
    blow_on_tree(*scene, blowing_toward(0.4, speed_m_s), 60 * 30);
    return bend_of(*scene, kTrunk, 0) / kRadPerDeg;
  };
  const auto drag = [](double speed_m_s) {
    const double square = speed_m_s * speed_m_s / 36.0;
    return square / std::pow(1.0 + square, 0.375);
  };
  for (const double speed_m_s : {1.5, 5.0, 12.0, 25.0}) {
    // 0.9 degrees for a drag of 1, and a little to the side (beta).
    const double along_and_across = 0.9 * std::hypot(1.0, 0.1);
    const double calm = speed_m_s / std::hypot(speed_m_s, 0.3);
    EXPECT_NEAR(trunk_deg(speed_m_s) / (along_and_across * calm * drag(speed_m_s)), 1.0, 0.02) << speed_m_s;
  }
}

TEST(TreeTest, LimbsSwayEachAtItsOwnPaceAfterAGust) {
  const auto scene = tree_scene(without_noise());  // of 8 limbs
  blow_on_tree(*scene, blowing_toward(0.0, 12.0), 900);
  std::array<std::vector<double>, 8> course;
  for (int tick = 0; tick < 420; ++tick) {
    scene->tick(wind::Vector{}, kTreeTick_s);
    for (std::size_t s = 0; s < course.size() && tick > 30; ++s) {
      course[s].push_back(static_cast<double>(bends_of(*scene, kLimbs).bend_south_rad[s]));
    }
  }
  Moments hz;
  for (const auto& one : course) {
    // From the first to the last time that it swings through its rest, half a period each.
    std::vector<double> through;
    for (std::size_t i = 1; i < one.size(); ++i) {
      if ((one[i] > 0.0) != (one[i - 1] > 0.0)) {
        through.push_back(static_cast<double>(i) - one[i] / (one[i] - one[i - 1]));
      }
    }
    ASSERT_GT(through.size(), 6U);
    hz.add(static_cast<double>(through.size() - 1) / (2.0 * kTreeTick_s * (through.back() - through.front())));
  }
  EXPECT_NEAR(hz.mean, 1.0, 0.15);
  EXPECT_GT(std::sqrt(hz.variance()), 0.08);
  EXPECT_LT(std::sqrt(hz.variance()), 0.3);
}

TEST(TreeTest, AGustThatCrossesTheCrownReachesTheLeavesOneAfterTheOther) {
  // Wide gusts across a wide crown: the sooner a twig stands upwind, the sooner its leaves lean.
  const auto scene = kTreeScene.make(
      ParameterValues::resolve(kTreeScene.parameters, little("cherry", {{"size", 3.0}, {"leaf_flutter", 0.0}})).value(),
      {.seed = 1, .gusts = shared_gusts()});
  const pose::TreeLevel& leaves = tree_of(*scene).levels[kLeaves];
  std::array<std::size_t, 2> sides = {0, 0};  // the spray that stands farthest west, and east
  for (std::size_t leaf = 0; leaf < leaves.strands.strand_count; leaf += 16) {
    if (leaves.strands.root_x_m[leaf] < leaves.strands.root_x_m[sides[0]]) sides[0] = leaf;
    if (leaves.strands.root_x_m[leaf] > leaves.strands.root_x_m[sides[1]]) sides[1] = leaf;
  }
  const double apart_m = static_cast<double>(leaves.strands.root_x_m[sides[1]] - leaves.strands.root_x_m[sides[0]]);
  GustyWind wind({3.0, 0.0}, 0.25F);  // toward east
  std::array<std::vector<double>, 2> course;
  for (int tick = 0; tick < 7200; ++tick) {
    scene->tick(wind.step(kTreeTick_s), kTreeTick_s);
    for (std::size_t side = 0; side < 2; ++side) {
      course[side].push_back(static_cast<double>(bends_of(*scene, kLeaves).bend_east_rad[sides[side]]));
    }
  }
  const auto alike = [&course](int lag) {
    Moments first;
    Moments second;
    double product = 0.0;
    const std::size_t count = course[0].size() - 600;
    for (std::size_t i = 0; i < count; ++i) {
      first.add(course[0][i]);
      second.add(course[1][i + static_cast<std::size_t>(lag)]);
      product += course[0][i] * course[1][i + static_cast<std::size_t>(lag)];
    }
    return (product / static_cast<double>(count) - first.mean * second.mean) /
           std::sqrt(first.variance() * second.variance());
  };
  const int crossing = static_cast<int>(std::lround(apart_m / 3.0 / kTreeTick_s));
  ASSERT_LT(crossing, 600);
  EXPECT_GT(alike(crossing), alike(0) + 0.1) << apart_m << " m apart";
}

TEST(TreeTest, LeavesFlutterFasterInAStrongerWind) {
  double before = 0.0;
  for (const double speed_m_s : {1.0, 4.0, 9.0, 16.0}) {
    const double hz = 0.5 * crossings_per_s(*tree_scene(little()), kLeaves, blowing_toward(1.2, speed_m_s));
    EXPECT_GT(hz, 1.1 * before) << speed_m_s;
    before = hz;
  }
  EXPECT_LT(before, 9.0);  // and never so fast that 60 ticks a second could not show it
}

TEST(TreeTest, LeansToWhereTheWindBlows) {
  for (int azimuth_deg = 0; azimuth_deg < 360; azimuth_deg += 45) {
    const double azimuth_rad = azimuth_deg * kRadPerDeg;
    const auto scene = tree_scene(little());
    const pose::TreeJoints rest = tree_joints(*scene);
    blow_on_tree(*scene, blowing_toward(azimuth_rad, 12.0), 60);
    Moments downwind_m;
    Moments sideways_m;
    for (int sample = 0; sample < 20; ++sample) {
      blow_on_tree(*scene, blowing_toward(azimuth_rad, 12.0), 60);
      const pose::TreeJoints joints = tree_joints(*scene);
      for (std::size_t leaf = 0; leaf < 1600; leaf += 16) {
        const auto x_m =
            static_cast<double>(joints.level(kLeaves).joint(leaf, 3).x_m - rest.level(kLeaves).joint(leaf, 3).x_m);
        const auto z_m =
            static_cast<double>(joints.level(kLeaves).joint(leaf, 3).z_m - rest.level(kLeaves).joint(leaf, 3).z_m);
        downwind_m.add(x_m * std::sin(azimuth_rad) - z_m * std::cos(azimuth_rad));
        sideways_m.add(x_m * std::cos(azimuth_rad) + z_m * std::sin(azimuth_rad));
      }
    }
    EXPECT_GT(downwind_m.mean, 0.05) << azimuth_deg;
    EXPECT_LT(std::abs(sideways_m.mean), 0.5 * downwind_m.mean) << azimuth_deg;
  }
}

/// How far the leaves of a tree are downwind of where they are at rest, on average, over the crown's width there.
double stream_share(std::string_view species, double speed_m_s) {
  constexpr double kToward_rad = 1.2;
  const auto scene = tree_scene(little(species));
  const pose::TreeJoints rest = tree_joints(*scene);
  const std::size_t tip = tree_of(*scene).levels[kLeaves].strands.links_per_strand - 1;
  const auto downwind_m = [&](const pose::TreeJoints& joints, std::size_t leaf) {
    const pose::JointPosition at = joints.level(kLeaves).joint(leaf, tip);
    return static_cast<double>(at.x_m) * std::sin(kToward_rad) - static_cast<double>(at.z_m) * std::cos(kToward_rad);
  };
  Moments moved_m;
  double low_m = 1e9;
  double high_m = -1e9;
  for (int sample = 0; sample < 10; ++sample) {
    blow_on_tree(*scene, blowing_toward(kToward_rad, speed_m_s), 60);
    const pose::TreeJoints joints = tree_joints(*scene);
    for (std::size_t leaf = 0; leaf < 1600; ++leaf) {
      moved_m.add(downwind_m(joints, leaf) - downwind_m(rest, leaf));
      low_m = std::min(low_m, downwind_m(rest, leaf));
      high_m = std::max(high_m, downwind_m(rest, leaf));
    }
  }
  return moved_m.mean / (high_m - low_m);
}

TEST(TreeTest, InAStormTheCrownStreamsToTheLeeFartherThanInABreeze) {
  for (const auto& [species, least] : {std::pair{"cherry", 0.075}, {"zelkova", 0.14}, {"poplar", 0.2}}) {
    const double breeze = stream_share(species, 4.0);
    const double storm = stream_share(species, 16.0);
    std::printf("%s: %.3f of the width at 4 m/s, %.3f at 16 m/s\n", species, breeze, storm);
    EXPECT_GT(storm - breeze, least) << species;
  }
}

TEST(TreeTest, LinksKeepTheirLengthTo1e5AndTheFootStandsStill) {
  const auto scene = tree_scene();
  const pose::TreeSkeleton& tree = tree_of(*scene);
  for (int storm = 0; storm < 3; ++storm) {
    blow_on_tree(*scene, blowing_toward(storm, 15.0 * storm), 60);
    const pose::TreeJoints joints = tree_joints(*scene);
    for (std::size_t part = 0; part < kTreePartCount; ++part) {
      const pose::TreeLevel& level = tree.levels[part];
      for (std::size_t s = 0; s < level.strands.strand_count; ++s) {
        pose::JointPosition from{level.strands.root_x_m[s], level.strands.root_y_m[s], level.strands.root_z_m[s]};
        if (part > 0) from = joints.level(level.parent_level).joint(level.parent[s], level.parent_link[s]);
        const auto length_m = static_cast<double>(level.strands.link_length_m[s]);
        for (std::size_t link = 0; link < level.strands.links_per_strand; ++link) {
          const pose::JointPosition to = joints.level(part).joint(s, link);
          const double found_m = std::hypot(static_cast<double>(to.x_m) - static_cast<double>(from.x_m),
                                            static_cast<double>(to.y_m) - static_cast<double>(from.y_m),
                                            static_cast<double>(to.z_m) - static_cast<double>(from.z_m));
          // To 1e-5 of it, beyond what floats 8 m off can say (a unit in the last place there is 1e-6 m).
          ASSERT_NEAR(found_m, length_m, 1e-5 * length_m + 1e-6);
          from = to;
        }
      }
    }
  }
}

/// How far each strand of a part is moved to and fro on average, after a while of a steady wind: the standard
/// deviation.
double liveliness_rad(Scene& scene, std::size_t part, wind::Vector wind, int ticks) {
  const std::size_t count = tree_of(scene).levels[part].strands.strand_count;
  std::vector<Moments> east(count);
  std::vector<Moments> south(count);
  blow_on_tree(scene, wind, 120);
  for (int tick = 0; tick < ticks; ++tick) {
    scene.tick(wind, kTreeTick_s);
    for (std::size_t s = 0; s < count; ++s) {
      east[s].add(static_cast<double>(bends_of(scene, part).bend_east_rad[s]));
      south[s].add(static_cast<double>(bends_of(scene, part).bend_south_rad[s]));
    }
  }
  double variance = 0.0;
  for (std::size_t s = 0; s < count; ++s) {
    variance += (east[s].variance() + south[s].variance()) / static_cast<double>(count);
  }
  return std::sqrt(variance);
}

TEST(TreeTest, PoplarLeavesFlutterInTheFaintestAirAndTwiceAsMuchAsCherryLeavesInAStorm) {
  for (const auto& [speed_m_s, times] : {std::pair{1.0, 6.0}, std::pair{3.0, 4.0}, std::pair{20.0, 1.8}}) {
    const auto cherry = tree_scene(little("cherry"));
    const auto poplar = tree_scene(little("poplar"));
    const wind::Vector wind = blowing_toward(0.5, speed_m_s);
    EXPECT_GT(liveliness_rad(*poplar, kLeaves, wind, 600), times * liveliness_rad(*cherry, kLeaves, wind, 600));
  }
}

TEST(TreeTest, TheThinnerTheWoodTheMoreItSways) {
  for (const std::string_view species : kTreeSpeciesNames) {
    double before = 0.0;
    for (const std::size_t part : {kTrunk, kLimbs, kTwigs}) {
      const auto scene = tree_scene(little(species, {{"hybrid", 0.0}}));
      const double sway_rad = liveliness_rad(*scene, part, blowing_toward(0.5, 8.0), 1200);
      EXPECT_GT(sway_rad, 1.5 * before) << species << " part " << part;
      before = sway_rad;
    }
  }
}

/// How often a second the east bends of a part pass through their mean.
double crossings_per_s(Scene& scene, std::size_t part, wind::Vector wind) {
  constexpr int kTicks = 1800;
  const std::size_t count = std::min<std::size_t>(tree_of(scene).levels[part].strands.strand_count, 64);
  std::vector<std::vector<double>> course(count);
  blow_on_tree(scene, wind, 120);
  for (int tick = 0; tick < kTicks; ++tick) {
    scene.tick(wind, kTreeTick_s);
    for (std::size_t s = 0; s < count; ++s) {
      course[s].push_back(static_cast<double>(bends_of(scene, part).bend_east_rad[s]));
    }
  }
  double crossings = 0.0;
  for (const auto& one : course) {
    Moments moments;
    for (const double bend : one) moments.add(bend);
    for (std::size_t i = 1; i < one.size(); ++i) {
      if ((one[i] > moments.mean) != (one[i - 1] > moments.mean)) crossings += 1.0;
    }
  }
  return crossings / static_cast<double>(count) / (kTicks * kTreeTick_s);
}

TEST(TreeTest, LeavesFlutterFasterThanBranchesSwayAndLimbsFasterThanTheTrunk) {
  const wind::Vector wind = blowing_toward(1.2, 8.0);
  const double leaves = crossings_per_s(*tree_scene(little()), kLeaves, wind);
  const double twigs = crossings_per_s(*tree_scene(little()), kTwigs, wind);
  const double trunk = crossings_per_s(*tree_scene(little()), kTrunk, wind);
  EXPECT_GT(leaves, 1.5 * twigs);
  EXPECT_GT(twigs, 1.2 * trunk);
}

TEST(TreeTest, NeighbouringLeavesMoveMoreAlikeThanDistantOnes) {
  // The size of a bend shows the flutter if the lean beneath it is slight.
  const auto scene = tree_scene(little("poplar", {{"leaf_lean", 40.0}}));
  const wind::Vector wind = blowing_toward(0.3, 6.0);
  blow_on_tree(*scene, wind, 120);
  std::vector<Moments> east(1600);
  std::vector<std::vector<double>> course(1600);
  for (int tick = 0; tick < 900; ++tick) {
    scene->tick(wind, kTreeTick_s);
    for (std::size_t leaf = 0; leaf < 1600; ++leaf) {
      course[leaf].push_back(bend_of(*scene, kLeaves, leaf));
      east[leaf].add(course[leaf].back());
    }
  }
  const auto correlation = [&](std::size_t a, std::size_t b) {
    double product = 0.0;
    for (std::size_t i = 0; i < course[a].size(); ++i) {
      product += (course[a][i] - east[a].mean) * (course[b][i] - east[b].mean);
    }
    return product / static_cast<double>(course[a].size()) / std::sqrt(east[a].variance() * east[b].variance());
  };
  // Pairs by how far apart they stand, up to a quarter of the shortest wave, and from 1 m on.
  const pose::StrandSkeleton& leaves = tree_of(*scene).levels[kLeaves].strands;
  Moments near;
  Moments far;
  for (std::size_t a = 0; a < 1600; a += 5) {
    for (std::size_t b = a + 1; b < 1600; b += 7) {
      const float apart_m = std::hypot(leaves.root_x_m[a] - leaves.root_x_m[b], leaves.root_y_m[a] - leaves.root_y_m[b],
                                       leaves.root_z_m[a] - leaves.root_z_m[b]);
      if (apart_m < 0.1F) near.add(correlation(a, b));
      if (apart_m > 1.0F && b % 4 == 0) far.add(correlation(a, b));
    }
  }
  EXPECT_GT(near.count, 50.0);
  EXPECT_GT(near.mean, 0.4);  // of the sizes of bends that go to and fro, each along an axis of its own
  EXPECT_LT(std::abs(far.mean), 0.3);
}

TEST(TreeTest, WindwardBranchesMoveUpAndDownAndLeeOnesSideways) {
  // On the two sides of the tree, the wind from every side: the share of the bend along the wind in how limbs and twigs
  // are bent to and fro. Bent along the wind, what stands out to windward or lee moves up and down.
  std::array<Moments, 2> limbs_along;
  std::array<Moments, 2> twigs_along;
  for (int azimuth_deg = 0; azimuth_deg < 360; azimuth_deg += 30) {
    const double azimuth_rad = azimuth_deg * kRadPerDeg;
    const double east = std::sin(azimuth_rad);
    const double south = -std::cos(azimuth_rad);
    const auto scene = tree_scene(little("cherry", {{"limbs", std::int64_t{40}}, {"hybrid", 0.0}}));
    const pose::TreeSkeleton& tree = tree_of(*scene);
    const pose::TreeJoints rest = tree_joints(*scene);
    std::array<std::vector<std::array<Moments, 2>>, kTreePartCount> bends;
    for (const TreePart part : {kLimbs, kTwigs}) bends[part].resize(tree.levels[part].strands.strand_count);
    blow_on_tree(*scene, blowing_toward(azimuth_rad, 10.0), 60);
    for (int sample = 0; sample < 300; ++sample) {
      blow_on_tree(*scene, blowing_toward(azimuth_rad, 10.0), 6);
      for (const TreePart part : {kLimbs, kTwigs}) {
        for (std::size_t s = 0; s < bends[part].size(); ++s) {
          const auto bend_east = static_cast<double>(bends_of(*scene, part).bend_east_rad[s]);
          const auto bend_south = static_cast<double>(bends_of(*scene, part).bend_south_rad[s]);
          bends[part][s][0].add(bend_east * east + bend_south * south);
          bends[part][s][1].add(bend_south * east - bend_east * south);
        }
      }
    }
    const auto add = [&](std::size_t part, double least_m, std::array<Moments, 2>& share_along) {
      for (std::size_t s = 0; s < bends[part].size(); ++s) {
        const pose::JointPosition middle = rest.level(part).joint(s, 7);
        const double downwind_m = static_cast<double>(middle.x_m) * east + static_cast<double>(middle.z_m) * south;
        if (std::abs(downwind_m) < least_m) continue;
        const double along = bends[part][s][0].variance();
        share_along[downwind_m < 0.0 ? 0 : 1].add(along / (along + bends[part][s][1].variance()));
      }
    };
    add(kLimbs, 1.0, limbs_along);
    add(kTwigs, 1.3, twigs_along);
  }
  EXPECT_GT(twigs_along[0].mean, 0.8);
  EXPECT_LT(twigs_along[1].mean, 0.4);
  EXPECT_GE(limbs_along[0].count, 8.0);
  EXPECT_GE(limbs_along[1].count, 8.0);
  EXPECT_GT(limbs_along[0].mean, 1.15 * limbs_along[1].mean);
}

TEST(TreeTest, BranchesSwayOnAfterAGustWhereTheyAreOscillators) {
  const auto turns = [](Scene& scene) {  // how often a twig changes between going and coming back
    blow_on_tree(scene, blowing_toward(0.0, 12.0), 900);
    int count = 0;
    double before = bend_of(scene, kTwigs, 0);
    double step = 0.0;
    for (int tick = 0; tick < 90; ++tick) {
      scene.tick(blowing_toward(0.0, 4.0), kTreeTick_s);
      const double now = bend_of(scene, kTwigs, 0);
      if ((now - before) * step < -1e-12) ++count;
      step = now - before;
      before = now;
    }
    return count;
  };
  EXPECT_LE(turns(*tree_scene(without_noise({{"hybrid", 0.0}}))), 1);
  EXPECT_GE(turns(*tree_scene(without_noise({{"hybrid", 1.0}}))), 3);
}

TEST(TreeTest, NoWindMovesAJointFartherThanTheBoundWhateverTheSpecies) {
  for (const std::string_view species : kTreeSpeciesNames) {
    for (const double hybrid : {0.0, 0.7, 1.0}) {
      const auto scene = tree_scene(little(species, {{"hybrid", hybrid}}));
      const double bound_m = scene->largest_joint_step_m(kTreeTick_s);
      pose::TreeJoints before = tree_joints(*scene);
      double largest_m = 0.0;
      for (int tick = 0; tick < 240; ++tick) {
        // Reversed again and again, turned through north, gone.
        const double speed_m_s = tick % 60 < 50 ? 60.0 : 0.0;
        const double azimuth_deg = tick < 120 ? (tick / 8 % 2 == 0 ? 20.0 : 200.0) : (tick / 5 % 2 == 0 ? 350.0 : 10.0);
        scene->tick(blowing_toward(azimuth_deg * kRadPerDeg, speed_m_s), kTreeTick_s);
        pose::TreeJoints now = tree_joints(*scene);
        for (std::size_t part = 0; part < kTreePartCount; ++part) {
          const pose::StrandSkeleton& strands = tree_of(*scene).levels[part].strands;
          for (std::size_t s = 0; s < strands.strand_count; ++s) {
            const pose::JointPosition a = before.level(part).joint(s, strands.links_per_strand - 1);
            const pose::JointPosition b = now.level(part).joint(s, strands.links_per_strand - 1);
            largest_m =
                std::max(largest_m, static_cast<double>(std::hypot(b.x_m - a.x_m, b.y_m - a.y_m, b.z_m - a.z_m)));
          }
        }
        before = std::move(now);
      }
      EXPECT_LE(largest_m, bound_m) << species << " hybrid " << hybrid;
      EXPECT_GT(largest_m, bound_m / 60.0) << species << " hybrid " << hybrid;
    }
  }
}

}  // namespace
}  // namespace yuragi::scenes
