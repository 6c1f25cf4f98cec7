#include "engine/scenes/tree_model.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <map>
#include <vector>

#include <gtest/gtest.h>

#include "engine/math/philox.hpp"
#include "engine/pose/pose_arrays.hpp"
#include "engine/pose/tree_kinematics.hpp"
#include "engine/scenes/tree_species.hpp"
#include "tests/support/bits.hpp"
#include "tests/support/random_strands.hpp"

namespace yuragi::scenes {
namespace {

TreeSpec spec_of(std::string_view species, std::uint64_t seed = 1) {
  return {.habit = tree_species(species).habit, .seed = seed};
}

pose::TreeJoints joints_in(const pose::TreeSkeleton& tree, const pose::TreePose& pose) {
  pose::TreeJoints joints(tree);
  EXPECT_EQ((pose::TreeKinematicsJob{.skeleton = &tree, .pose = &pose, .joints = &joints}.run()),
            pose::TreeKinematicsJob::Problem::kNone);
  return joints;
}

pose::TreePose resting(const pose::TreeSkeleton& tree) {
  return std::get<pose::TreePose>(pose::rest_pose(tree));
}

double gap_m(pose::JointPosition a, pose::JointPosition b) {
  return static_cast<double>(std::hypot(a.x_m - b.x_m, a.y_m - b.y_m, a.z_m - b.z_m));
}

TEST(TreeModelTest, HasThePapersSizeByDefault) {
  const pose::TreeSkeleton tree = make_tree(spec_of("cherry"));
  ASSERT_EQ(tree.levels.size(), kTreePartCount);
  EXPECT_EQ(tree.levels[kTrunk].strands.strand_count + tree.levels[kLimbs].strands.strand_count +
                tree.levels[kTwigs].strands.strand_count,
            256U);
  EXPECT_EQ(tree.levels[kTwigs].strands.links_per_strand, 256U);
  EXPECT_EQ(tree.levels[kLeaves].strands.strand_count, 10000U);
  EXPECT_EQ(pose::node_count(tree), 105'536U);
}

TEST(TreeModelTest, EveryKindOfTreeIsASoundSkeleton) {
  for (const std::string_view species : kTreeSpeciesNames) {
    for (const std::size_t limbs : {1U, 7U, 15U}) {
      TreeSpec spec = spec_of(species, limbs);
      spec.limbs = limbs;
      spec.twigs = limbs == 7 ? 3 : 40;
      spec.leaves = limbs == 1 ? 1 : 500;
      spec.branch_links = limbs == 15 ? 5 : 40;
      const pose::TreeSkeleton tree = make_tree(spec);
      const pose::TreeJoints joints = joints_in(tree, resting(tree));  // which checks sizes and parents
      for (std::size_t i = 0; i < kTreePartCount; ++i) {
        const pose::TreeLevel& level = tree.levels[i];
        const pose::StrandSkeleton& strands = level.strands;
        ASSERT_EQ(level.base_radius_m.size(), strands.padded_count());
        ASSERT_EQ(level.tip_radius_m.size(), strands.padded_count());
        for (std::size_t s = 0; s < strands.padded_count(); ++s) {
          EXPECT_NEAR(std::hypot(strands.rest_x[s], strands.rest_y[s], strands.rest_z[s]), 1.0F, 1e-6F);
          EXPECT_NEAR(std::hypot(strands.curl_x[s], strands.curl_y[s], strands.curl_z[s]), 1.0F, 1e-6F);
          EXPECT_NEAR(strands.rest_x[s] * strands.curl_x[s] + strands.rest_y[s] * strands.curl_y[s] +
                          strands.rest_z[s] * strands.curl_z[s],
                      0.0F, 1e-6F);
          EXPECT_GE(level.base_radius_m[s], level.tip_radius_m[s]);
          if (s >= strands.strand_count) continue;
          EXPECT_GT(level.tip_radius_m[s], 0.0F);
          EXPECT_GT(strands.link_length_m[s], 0.0F);
          if (i == kTrunk) continue;
          const pose::JointPosition root{strands.root_x_m[s], strands.root_y_m[s], strands.root_z_m[s]};
          EXPECT_LE(gap_m(root, joints.level(i - 1).joint(level.parent[s], level.parent_link[s])), 2e-5);
        }
      }
    }
  }
}

TEST(TreeModelTest, WoodIsAsThickAsWhatItCarries) {
  const pose::TreeSkeleton tree = make_tree(spec_of("zelkova"));
  for (const std::size_t part : {kLimbs, kTwigs}) {
    std::vector<double> carried_m2(tree.levels[part - 1].strands.strand_count, 0.0);
    for (std::size_t s = 0; s < tree.levels[part].strands.strand_count; ++s) {
      carried_m2[tree.levels[part].parent[s]] += std::pow(static_cast<double>(tree.levels[part].base_radius_m[s]), 2);
    }
    for (std::size_t p = 0; p < carried_m2.size(); ++p) {
      EXPECT_NEAR(std::pow(static_cast<double>(tree.levels[part - 1].base_radius_m[p]), 2), carried_m2[p],
                  1e-5 * carried_m2[p]);
    }
  }
}

TEST(TreeModelTest, LeavesStandInSpraysOf16OnOneTwigEach) {
  const pose::TreeSkeleton tree = make_tree(spec_of("poplar"));
  const pose::TreeLevel& leaves = tree.levels[kLeaves];
  EXPECT_TRUE(leaves.is_leaves);
  EXPECT_TRUE(leaves.is_turned_by_block);
  std::vector<std::size_t> on_twig(tree.levels[kTwigs].strands.strand_count, 0);
  for (std::size_t s = 0; s < leaves.strands.strand_count; ++s) {
    EXPECT_EQ(leaves.parent[s], leaves.parent[s / 16 * 16]);
    ++on_twig[leaves.parent[s]];
  }
  EXPECT_GE(*std::min_element(on_twig.begin(), on_twig.end()), 32U);
  EXPECT_LE(*std::max_element(on_twig.begin(), on_twig.end()), 48U);
}

/// The outline of a tree's wood: how high, how wide, and how high up it is widest.
struct Outline {
  double height_m = 0.0;
  double radius_m = 0.0;
  double widest_at_m = 0.0;
};

Outline outline_of(const pose::TreeSkeleton& tree) {
  Outline outline;
  const pose::TreeJoints joints = joints_in(tree, resting(tree));
  for (std::size_t i = kTrunk; i < kLeaves; ++i) {
    const pose::StrandSkeleton& strands = tree.levels[i].strands;
    for (std::size_t s = 0; s < strands.strand_count; ++s) {
      const pose::JointPosition tip = joints.level(i).joint(s, strands.links_per_strand - 1);
      const auto radius_m = static_cast<double>(std::hypot(tip.x_m, tip.z_m));
      if (radius_m > outline.radius_m) outline.widest_at_m = static_cast<double>(tip.y_m);
      outline.radius_m = std::max(outline.radius_m, radius_m);
      outline.height_m = std::max(outline.height_m, static_cast<double>(tip.y_m));
    }
  }
  return outline;
}

TEST(TreeModelTest, EachSpeciesHasItsHabit) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const Outline cherry = outline_of(make_tree(spec_of("cherry", seed)));
    const Outline zelkova = outline_of(make_tree(spec_of("zelkova", seed)));
    const Outline poplar = outline_of(make_tree(spec_of("poplar", seed)));
    for (const auto& [outline, species] :
         {std::pair{cherry, "cherry"}, std::pair{zelkova, "zelkova"}, std::pair{poplar, "poplar"}}) {
      EXPECT_NEAR(outline.height_m, tree_species(species).habit.height_m, 0.25 * outline.height_m) << species;
    }
    EXPECT_GT(2.0 * cherry.radius_m, 1.05 * cherry.height_m);   // broader than high
    EXPECT_GT(2.0 * zelkova.radius_m, 0.6 * zelkova.height_m);  // a vase
    EXPECT_LT(2.0 * zelkova.radius_m, 0.8 * 2.0 * cherry.radius_m / cherry.height_m * zelkova.height_m);
    EXPECT_GT(zelkova.widest_at_m, 0.6 * zelkova.height_m);
    EXPECT_LT(2.0 * poplar.radius_m, 0.35 * poplar.height_m);  // a column
  }
}

/// How far the middle of a limb lies beside the straight line from foot to tip, over the length of that line.
double bow_of(const pose::TreeSkeleton& tree, const pose::TreeJoints& joints, std::size_t limb) {
  const pose::StrandSkeleton& limbs = tree.levels[kLimbs].strands;
  const pose::JointPosition foot{limbs.root_x_m[limb], limbs.root_y_m[limb], limbs.root_z_m[limb]};
  const pose::JointPosition middle = joints.level(kLimbs).joint(limb, limbs.links_per_strand / 2 - 1);
  const pose::JointPosition tip = joints.level(kLimbs).joint(limb, limbs.links_per_strand - 1);
  const pose::JointPosition half_way{0.5F * (foot.x_m + tip.x_m), 0.5F * (foot.y_m + tip.y_m),
                                     0.5F * (foot.z_m + tip.z_m)};
  return gap_m(middle, half_way) / gap_m(foot, tip);
}

TEST(TreeModelTest, LimbsCurve) {
  for (const auto& [species, least] : {std::pair{"cherry", 0.035}, {"zelkova", 0.018}, {"poplar", 0.03}}) {
    const pose::TreeSkeleton tree = make_tree(spec_of(species));
    const pose::TreeJoints joints = joints_in(tree, resting(tree));
    std::vector<double> bows;
    for (std::size_t i = 0; i < tree.levels[kLimbs].strands.strand_count; ++i) {
      bows.push_back(bow_of(tree, joints, i));
    }
    std::sort(bows.begin(), bows.end());
    std::printf("%s: bow %.3f\n", species, bows[bows.size() / 2]);
    EXPECT_GT(bows[bows.size() / 2], least) << species;
  }
}

/// How unevenly leaves fill the crown: the variance of their number in cells of 0.5 m within blocks of 2 m that have
/// leaves enough, over the square of its mean there, less what chance alone gives (Poisson).
double clumpiness_of(const pose::TreeSkeleton& tree) {
  constexpr int kCells = 4;
  constexpr double kCell_m = 0.5;
  constexpr double kMinLeaves = 2.0 * kCells * kCells * kCells;
  const pose::StrandSkeleton& leaves = tree.levels[kLeaves].strands;
  std::map<std::array<int, 3>, std::map<std::array<int, 3>, double>> blocks;
  for (std::size_t i = 0; i < leaves.strand_count; ++i) {
    const auto cell = [](float place_m) {
      return static_cast<int>(std::floor(static_cast<double>(place_m) / kCell_m));
    };
    const std::array cells{cell(leaves.root_x_m[i]), cell(leaves.root_y_m[i]), cell(leaves.root_z_m[i])};
    const auto block = [](int place) { return (place + 1000 * kCells) / kCells; };
    blocks[{block(cells[0]), block(cells[1]), block(cells[2])}][cells] += 1.0;
  }
  double sum = 0.0;
  double count = 0.0;
  for (const auto& [block, cells] : blocks) {
    double all = 0.0;
    double squares = 0.0;
    for (const auto& [cell, in_cell] : cells) {
      all += in_cell;
      squares += in_cell * in_cell;
    }
    if (all < kMinLeaves) continue;
    const double mean = all / (kCells * kCells * kCells);
    sum += all * (squares / (kCells * kCells * kCells) - mean * mean - mean) / (mean * mean);
    count += all;
  }
  return sum / count;
}

TEST(TreeModelTest, LeavesHangInClumpsWithGapsBetween) {
  for (const auto& [species, least] : {std::pair{"cherry", 3.5}, {"zelkova", 3.5}, {"poplar", 5.5}}) {
    double clumpiness = 0.0;
    for (std::uint64_t seed = 1; seed <= 5; ++seed) clumpiness += clumpiness_of(make_tree(spec_of(species, seed))) / 5;
    std::printf("%s: clumpiness %.2f\n", species, clumpiness);
    EXPECT_GT(clumpiness, least) << species;
  }
}

TEST(TreeModelTest, SizeIsAllLengths) {
  TreeSpec spec = spec_of("cherry");
  const pose::TreeSkeleton one = make_tree(spec);
  spec.size = 2.0;
  const pose::TreeSkeleton two = make_tree(spec);
  for (std::size_t i = 0; i < kTreePartCount; ++i) {
    for (std::size_t s = 0; s < one.levels[i].strands.strand_count; s += 7) {
      EXPECT_NEAR(two.levels[i].strands.root_y_m[s], 2.0F * one.levels[i].strands.root_y_m[s], 1e-5F);
      EXPECT_NEAR(two.levels[i].strands.link_length_m[s], 2.0F * one.levels[i].strands.link_length_m[s], 1e-6F);
      EXPECT_NEAR(two.levels[i].base_radius_m[s], 2.0F * one.levels[i].base_radius_m[s], 1e-6F);
    }
  }
}

TEST(TreeModelTest, AGrovesTreesStandApartAndWithinItsRadius) {
  EXPECT_TRUE(grove_of(1, 20.0, 1).x_m.empty());
  const pose::TreeCopies grove = grove_of(12, 30.0, 1);
  ASSERT_EQ(grove.x_m.size(), 11U);
  EXPECT_EQ(grove, grove_of(12, 30.0, 1));
  EXPECT_NE(grove, grove_of(12, 30.0, 2));
  for (std::size_t i = 0; i < grove.x_m.size(); ++i) {
    EXPECT_LE(std::hypot(grove.x_m[i], grove.z_m[i]), 30.0F + 0.3F * 30.0F / std::sqrt(12.0F));
    EXPECT_GE(grove.scale[i], 0.8F);
    EXPECT_LE(grove.scale[i], 1.15F);
    EXPECT_GT(std::hypot(grove.x_m[i], grove.z_m[i]), 3.0F) << "the tree itself stands in the middle";
    for (std::size_t k = 0; k < i; ++k) {
      EXPECT_GT(std::hypot(grove.x_m[i] - grove.x_m[k], grove.z_m[i] - grove.z_m[k]), 3.0F);
    }
  }
}

TEST(TreeModelTest, TheSameSeedGivesTheSameTreeAndAnotherSeedAnother) {
  const pose::TreeSkeleton tree = make_tree(spec_of("cherry", 4));
  const pose::TreeSkeleton same = make_tree(spec_of("cherry", 4));
  const pose::TreeSkeleton other = make_tree(spec_of("cherry", 5));
  for (std::size_t i = 1; i < kTreePartCount; ++i) {
    EXPECT_EQ(bits_of(tree.levels[i].strands.root_x_m), bits_of(same.levels[i].strands.root_x_m));
    EXPECT_NE(bits_of(tree.levels[i].strands.root_x_m), bits_of(other.levels[i].strands.root_x_m));
  }
}

TEST(TreeModelTest, NoChangeOfTheBendsMovesAJointFartherThanTheLeversSay) {
  TreeSpec spec = spec_of("zelkova");
  spec.twigs = 60;
  spec.leaves = 480;
  spec.branch_links = 12;
  const pose::TreeSkeleton tree = make_tree(spec);
  const auto levers_m = tree_levers_m(tree);
  EXPECT_EQ(levers_m[kTreePartCount], 0.0);
  double largest_share = 0.0;
  for (std::uint64_t trial = 0; trial < 200; ++trial) {
    // Some pose, and one that differs by up to `change_rad` in some of the levels.
    pose::TreePose before;
    pose::TreePose after;
    double allowed_m = 0.0;
    for (std::size_t i = 0; i < kTreePartCount; ++i) {
      before.levels.push_back(random_bends(tree.levels[i].strands, 1.2, 7 * trial + i));
      pose::StrandPose changed = before.levels.back();
      const double change_rad = (trial >> i & 1U) == 0 ? 0.0 : 0.1 * static_cast<double>(trial % 7 + 1);
      const pose::StrandPose change = random_bends(tree.levels[i].strands, change_rad, 1000 + 7 * trial + i);
      for (std::size_t s = 0; s < change.bend_east_rad.size(); ++s) {
        // All toward one side in every other trial: then they add up.
        const bool is_common = trial % 2 == 0;
        changed.bend_east_rad[s] += is_common ? static_cast<float>(change_rad) : change.bend_east_rad[s];
        changed.bend_south_rad[s] += is_common ? 0.0F : change.bend_south_rad[s];
      }
      after.levels.push_back(changed);
      allowed_m += levers_m[i] * change_rad;
    }
    const pose::TreeJoints from = joints_in(tree, before);
    const pose::TreeJoints to = joints_in(tree, after);
    for (std::size_t i = 0; i < kTreePartCount; ++i) {
      const pose::StrandSkeleton& strands = tree.levels[i].strands;
      for (std::size_t s = 0; s < strands.strand_count; ++s) {
        for (std::size_t link = 0; link < strands.links_per_strand; ++link) {
          const double way_m = gap_m(from.level(i).joint(s, link), to.level(i).joint(s, link));
          ASSERT_LE(way_m, allowed_m + 1e-5);
          if (allowed_m > 0.0) largest_share = std::max(largest_share, way_m / allowed_m);
        }
      }
    }
  }
  EXPECT_GT(largest_share, 0.2);  // the levers are not idle talk
}

}  // namespace
}  // namespace yuragi::scenes
