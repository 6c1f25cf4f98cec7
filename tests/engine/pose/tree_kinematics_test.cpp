#include "engine/pose/tree_kinematics.hpp"

#include <array>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "engine/math/philox.hpp"
#include "tests/support/bits.hpp"
#include "tests/support/each_simd_row.hpp"
#include "tests/support/random_strands.hpp"

namespace yuragi::pose {
namespace {

using TreeProblem = TreeKinematicsJob::Problem;
using TreeVector3 = std::array<double, 3>;
using TreeMatrix3 = std::array<TreeVector3, 3>;

constexpr TreeMatrix3 kNoTurn = {{{1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}}};

TreeVector3 operator*(const TreeMatrix3& m, const TreeVector3& v) {
  TreeVector3 result = {};
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t k = 0; k < 3; ++k) result[i] += m[i][k] * v[k];
  }
  return result;
}

TreeMatrix3 operator*(const TreeMatrix3& a, const TreeMatrix3& b) {
  TreeMatrix3 result = {};
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      for (std::size_t k = 0; k < 3; ++k) result[i][j] += a[i][k] * b[k][j];
    }
  }
  return result;
}

/// The turn about up x bend by `share` of the bend's angle (Rodrigues).
TreeMatrix3 turn_by(double east_rad, double south_rad, double share) {
  const double angle = std::hypot(east_rad, south_rad);
  if (angle == 0.0) return kNoTurn;
  const TreeVector3 a = {south_rad / angle, 0.0, -east_rad / angle};
  const double c = std::cos(share * angle);
  const double s = std::sin(share * angle);
  TreeMatrix3 m;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) m[i][j] = (i == j ? c : 0.0) + (1.0 - c) * a[i] * a[j];
  }
  m[0][1] -= s * a[2];
  m[0][2] += s * a[1];
  m[1][0] += s * a[2];
  m[1][2] -= s * a[0];
  m[2][0] -= s * a[1];
  m[2][1] += s * a[0];
  return m;
}

double number(float value) {
  return static_cast<double>(value);
}
TreeVector3 place_of(JointPosition joint) {
  return {number(joint.x_m), number(joint.y_m), number(joint.z_m)};
}
double distance(const TreeVector3& a, const TreeVector3& b) {
  return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

/// What skeleton.hpp says, word for word and in double.
class Reference {
 public:
  Reference(const TreeSkeleton& tree, const TreePose& pose) : tree_(tree), pose_(pose) {}

  TreeMatrix3 root_turn(std::size_t level, std::size_t strand) const {
    if (level == 0) return kNoTurn;
    const TreeLevel& here = tree_.levels[level];
    const std::size_t of = here.is_turned_by_block ? strand / kStrandsPerBlock * kStrandsPerBlock : strand;
    return link_turn(here.parent_level, here.parent[of], here.parent_link[of]);
  }

  TreeMatrix3 link_turn(std::size_t level, std::size_t strand, std::size_t link) const {
    const double links = static_cast<double>(tree_.levels[level].strands.links_per_strand);
    return turn_by(number(pose_.levels[level].bend_east_rad[strand]),
                   number(pose_.levels[level].bend_south_rad[strand]), static_cast<double>(link + 1) / links) *
           root_turn(level, strand);
  }

  TreeVector3 root(std::size_t level, std::size_t strand) const {
    const TreeLevel& here = tree_.levels[level];
    if (level > 0) return joint(here.parent_level, here.parent[strand], here.parent_link[strand]);
    return {number(here.strands.root_x_m[strand]), number(here.strands.root_y_m[strand]),
            number(here.strands.root_z_m[strand])};
  }

  TreeVector3 joint(std::size_t level, std::size_t strand, std::size_t link) const {
    const StrandSkeleton& strands = tree_.levels[level].strands;
    TreeVector3 at = root(level, strand);
    for (std::size_t k = 0; k <= link; ++k) {
      const double curled_rad = static_cast<double>(k) * number(strands.rest_curl_rad[strand]);
      const double c = std::cos(curled_rad);
      const double s = std::sin(curled_rad);
      const TreeVector3 rest = {number(strands.rest_x[strand]) * c + number(strands.curl_x[strand]) * s,
                                number(strands.rest_y[strand]) * c + number(strands.curl_y[strand]) * s,
                                number(strands.rest_z[strand]) * c + number(strands.curl_z[strand]) * s};
      const TreeVector3 now = link_turn(level, strand, k) * rest;
      for (std::size_t i = 0; i < 3; ++i) at[i] += number(strands.link_length_m[strand]) * now[i];
    }
    return at;
  }

 private:
  const TreeSkeleton& tree_;
  const TreePose& pose_;
};

TreePose no_bends(const TreeSkeleton& tree) {
  TreePose pose;
  for (const TreeLevel& level : tree.levels) {
    const std::vector<float> zeros(level.strands.padded_count());
    pose.levels.push_back({zeros, zeros});
  }
  return pose;
}

TreePose some_bends(const TreeSkeleton& tree, double largest_rad) {
  TreePose pose;
  for (std::size_t i = 0; i < tree.levels.size(); ++i) {
    pose.levels.push_back(random_bends(tree.levels[i].strands, largest_rad, i));
  }
  return pose;
}

/// A wild tree: strands of every kind, each on some link of some strand of a level below (twice the one right below,
/// once the ground floor), the last level turned by block.
TreeSkeleton wild_tree() {
  TreeSkeleton tree;
  const std::array<std::size_t, 5> strands = {3, 20, 40, 17, 100};
  const std::array<std::size_t, 5> links = {8, 5, 1, 6, 4};
  const std::array<std::size_t, 5> parent_level = {0, 0, 1, 0, 2};
  for (std::size_t i = 0; i < strands.size(); ++i) {
    TreeLevel& level = tree.levels.emplace_back();
    level.strands = random_strands(strands[i], links[i], 0.2, i);
    level.is_turned_by_block = i == 4;
    if (i == 0) continue;
    level.parent_level = parent_level[i];
    const StrandSkeleton& parents = tree.levels[level.parent_level].strands;
    const math::RandomStream random(i, math::stream_id("wild tree"));
    for (std::size_t s = 0; s < level.strands.padded_count(); ++s) {
      const auto below = [&](std::size_t index, std::size_t count) {
        return static_cast<std::uint32_t>(random.uniform(index) * static_cast<double>(count));
      };
      level.parent.push_back(below(2 * s, parents.strand_count));
      level.parent_link.push_back(below(2 * s + 1, parents.links_per_strand));
    }
  }
  // The roots stand where the parents are at rest.
  const TreePose rest = no_bends(tree);
  const Reference reference(tree, rest);
  for (std::size_t i = 1; i < tree.levels.size(); ++i) {
    StrandSkeleton& own = tree.levels[i].strands;
    for (std::size_t s = 0; s < own.padded_count(); ++s) {
      const TreeVector3 root = reference.root(i, s);
      own.root_x_m[s] = static_cast<float>(root[0]);
      own.root_y_m[s] = static_cast<float>(root[1]);
      own.root_z_m[s] = static_cast<float>(root[2]);
    }
  }
  return tree;
}

TreeJoints joints_of(const TreeSkeleton& tree, const TreePose& pose, std::optional<SimdRow> row = {}) {
  TreeJoints joints(tree);
  EXPECT_EQ((TreeKinematicsJob{.skeleton = &tree, .pose = &pose, .row = row, .joints = &joints}.run()),
            TreeProblem::kNone);
  return joints;
}

class TreeKinematicsOnEachRow : public EachSimdRow {};
YURAGI_ON_EACH_ROW(TreeKinematicsOnEachRow);

TEST_P(TreeKinematicsOnEachRow, ComputesTheSameBitsAsTheBaseRow) {
  const TreeSkeleton tree = wild_tree();
  const TreePose pose = some_bends(tree, 3.0);
  const TreeJoints expected = joints_of(tree, pose, kBaseSimdRow);
  const TreeJoints found = joints_of(tree, pose, GetParam());
  for (std::size_t i = 0; i < tree.levels.size(); ++i) {
    EXPECT_EQ(bits_of(found.level(i).data()), bits_of(expected.level(i).data())) << i;
  }
}

TEST_P(TreeKinematicsOnEachRow, PutsEachJointWhereTheDefinitionSays) {
  const TreeSkeleton tree = wild_tree();
  for (const double largest_rad : {0.0, 1e-6, 0.3, 3.0}) {
    const TreePose pose = some_bends(tree, largest_rad);
    const TreeJoints joints = joints_of(tree, pose, GetParam());
    const Reference reference(tree, pose);
    for (std::size_t i = 0; i < tree.levels.size(); ++i) {
      const StrandSkeleton& strands = tree.levels[i].strands;
      for (std::size_t s = 0; s < strands.strand_count; ++s) {
        for (std::size_t link = 0; link < strands.links_per_strand; ++link) {
          EXPECT_LE(distance(place_of(joints.level(i).joint(s, link)), reference.joint(i, s, link)), 1e-5);
        }
      }
    }
  }
}

TEST_P(TreeKinematicsOnEachRow, LinksKeepTheirLengthTo1e5OfIt) {
  const TreeSkeleton tree = wild_tree();
  const TreeJoints joints = joints_of(tree, some_bends(tree, 3.0), GetParam());
  for (std::size_t i = 0; i < tree.levels.size(); ++i) {
    const TreeLevel& level = tree.levels[i];
    for (std::size_t s = 0; s < level.strands.strand_count; ++s) {
      const double length_m = number(level.strands.link_length_m[s]);
      TreeVector3 from = {};
      if (i > 0) from = place_of(joints.level(level.parent_level).joint(level.parent[s], level.parent_link[s]));
      for (std::size_t link = 0; link < level.strands.links_per_strand; ++link) {
        const TreeVector3 to = place_of(joints.level(i).joint(s, link));
        EXPECT_NEAR(distance(from, to), length_m, 1e-5 * length_m);
        from = to;
      }
    }
  }
}

TEST(TreeKinematicsTest, TheRestPoseIsTheSkeletonAsItStands) {
  const TreeSkeleton tree = wild_tree();
  const TreeJoints joints = joints_of(tree, no_bends(tree));
  for (std::size_t i = 0; i < tree.levels.size(); ++i) {
    const StrandSkeleton& strands = tree.levels[i].strands;
    const StrandPose rest = no_bends(tree).levels[i];
    JointPositions standing(strands);
    StrandKinematicsJob{.skeleton = &strands, .pose = &rest, .joints = &standing}.run();
    for (std::size_t k = 0; k < standing.data().size(); ++k) {
      EXPECT_NEAR(joints.level(i).data()[k], standing.data()[k], 2e-6F);
    }
  }
}

TEST(TreeKinematicsTest, ABentTrunkCarriesWhatGrowsOnItAsOneRigidThing) {
  const TreeSkeleton tree = wild_tree();
  TreePose pose = no_bends(tree);
  pose.levels[0] = random_bends(tree.levels[0].strands, 1.5, 7);
  const TreeJoints rest = joints_of(tree, no_bends(tree));
  const TreeJoints bent = joints_of(tree, pose);
  const StrandSkeleton& limbs = tree.levels[1].strands;
  double moved_m = 0.0;
  for (std::size_t s = 0; s < limbs.strand_count; ++s) {
    const TreeVector3 tip_at_rest = place_of(rest.level(1).joint(s, 4));
    const TreeVector3 tip = place_of(bent.level(1).joint(s, 4));
    moved_m = std::max(moved_m, distance(tip, tip_at_rest));
    for (std::size_t link = 0; link < 4; ++link) {
      EXPECT_NEAR(distance(place_of(bent.level(1).joint(s, link)), tip),
                  distance(place_of(rest.level(1).joint(s, link)), tip_at_rest), 1e-5);
    }
  }
  EXPECT_GT(moved_m, 0.5);

  // And what grows on the limbs keeps its distance from the whole limb.
  const TreeLevel& twigs = tree.levels[2];
  for (std::size_t s = 0; s < twigs.strands.strand_count; ++s) {
    for (std::size_t link = 0; link < 5; ++link) {
      EXPECT_NEAR(distance(place_of(bent.level(2).joint(s, 0)), place_of(bent.level(1).joint(twigs.parent[s], link))),
                  distance(place_of(rest.level(2).joint(s, 0)), place_of(rest.level(1).joint(twigs.parent[s], link))),
                  1e-5);
    }
  }
}

TEST(TreeKinematicsTest, EveryFiniteBendHasFiniteJoints) {
  const TreeSkeleton tree = wild_tree();
  TreePose pose = no_bends(tree);
  const std::array extremes = {0.0F, -0.0F, 1e-45F, 1e-16F, 1.0F, -32.0F, 50.0F, 1e10F, -1e30F, 3e38F};
  for (StrandPose& level : pose.levels) {
    for (std::size_t i = 0; i < level.bend_east_rad.size(); ++i) {
      level.bend_east_rad[i] = extremes[i % 10];
      level.bend_south_rad[i] = extremes[i * 3 / 10 % 10];
    }
  }
  const TreeJoints joints = joints_of(tree, pose);
  for (std::size_t i = 0; i < tree.levels.size(); ++i) {
    for (const float coordinate : joints.level(i).data()) {
      ASSERT_TRUE(std::isfinite(coordinate));
      ASSERT_LE(std::abs(coordinate), 4.01F);
    }
  }
}

/// What a tree is refused for after `spoil` has had it.
template <class Spoil>
TreeProblem problem_after(Spoil spoil) {
  TreeSkeleton tree = wild_tree();
  TreePose pose = no_bends(tree);
  TreeJoints joints(tree);
  spoil(tree, pose);
  const TreeProblem problem = TreeKinematicsJob{.skeleton = &tree, .pose = &pose, .joints = &joints}.run();
  if (problem != TreeProblem::kNone) {
    for (const float coordinate : joints.level(0).data()) EXPECT_EQ(coordinate, 0.0F) << "something was done";
  }
  return problem;
}

TEST(TreeKinematicsTest, RefusesParentsThatAreNotThere) {
  EXPECT_EQ(problem_after([](TreeSkeleton&, TreePose&) {}), TreeProblem::kNone);
  EXPECT_EQ(problem_after([](TreeSkeleton& tree, TreePose&) { tree.levels[1].parent[5] = 16; }),
            TreeProblem::kSkeletonSize);
  EXPECT_EQ(problem_after([](TreeSkeleton& tree, TreePose&) { tree.levels[4].parent.back() = 0xFFFFFFFFU; }),
            TreeProblem::kSkeletonSize);
  EXPECT_EQ(problem_after([](TreeSkeleton& tree, TreePose&) { tree.levels[1].parent_link[31] = 8; }),
            TreeProblem::kSkeletonSize);
  EXPECT_EQ(problem_after([](TreeSkeleton& tree, TreePose&) { tree.levels[3].parent_level = 3; }),
            TreeProblem::kSkeletonSize);
  EXPECT_EQ(problem_after([](TreeSkeleton& tree, TreePose&) { tree.levels[3].parent_level = 99; }),
            TreeProblem::kSkeletonSize);
  EXPECT_EQ(problem_after([](TreeSkeleton& tree, TreePose&) { tree.levels[2].parent.pop_back(); }),
            TreeProblem::kSkeletonSize);
  EXPECT_EQ(problem_after([](TreeSkeleton& tree, TreePose&) { tree.levels[0].parent.assign(16, 0); }),
            TreeProblem::kSkeletonSize);
}

TEST(TreeKinematicsTest, SaysWhatElseIsWrongAndThenDoesNothing) {
  const TreeSkeleton tree = wild_tree();
  const TreePose pose = no_bends(tree);
  TreeJoints joints(tree);
  for (int missing = 0; missing < 3; ++missing) {
    TreeKinematicsJob job{.skeleton = &tree, .pose = &pose, .joints = &joints};
    if (missing == 0) job.skeleton = nullptr;
    if (missing == 1) job.pose = nullptr;
    if (missing == 2) job.joints = nullptr;
    EXPECT_EQ(job.run(), TreeProblem::kMissingPart);
  }
  EXPECT_EQ(problem_after([](TreeSkeleton& spoilt, TreePose&) { spoilt.levels.clear(); }), TreeProblem::kSkeletonSize);
  EXPECT_EQ(problem_after([](TreeSkeleton& spoilt, TreePose&) { spoilt.levels.resize(kMaxTreeLevels + 1); }),
            TreeProblem::kSkeletonSize);
  EXPECT_EQ(problem_after([](TreeSkeleton& spoilt, TreePose&) { spoilt.levels[2].strands.curl_x.pop_back(); }),
            TreeProblem::kSkeletonSize);
  EXPECT_EQ(problem_after([](TreeSkeleton&, TreePose& spoilt) { spoilt.levels.pop_back(); }), TreeProblem::kPoseSize);
  EXPECT_EQ(problem_after([](TreeSkeleton&, TreePose& spoilt) { spoilt.levels[4].bend_south_rad.pop_back(); }),
            TreeProblem::kPoseSize);
  EXPECT_EQ(problem_after([](TreeSkeleton& spoilt, TreePose&) { spoilt.levels[4].is_turned_by_block = false; }),
            TreeProblem::kJointsSize);
  EXPECT_EQ(problem_after([](TreeSkeleton& spoilt, TreePose&) { ++spoilt.levels[4].strands.links_per_strand; }),
            TreeProblem::kJointsSize);
}

}  // namespace
}  // namespace yuragi::pose
