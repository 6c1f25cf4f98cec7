#include "viewer/meshes/trees/tree_parts.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <gtest/gtest.h>

#include "engine/pose/pose_arrays.hpp"
#include "engine/pose/tree_kinematics.hpp"
#include "tests/viewer/test_models.hpp"

namespace yuragi::viewer::meshes::trees {
namespace {

class TreePartsTest : public testing::Test {
 protected:
  const pose::TreeSkeleton tree_ = std::get<pose::TreeSkeleton>(test_model("tree").skeleton);
};

TEST_F(TreePartsTest, FindTheJointThatTheyGrowFrom) {
  // In the rest pose each root of the skeleton is the parent's joint, in the array of all levels as it is uploaded.
  pose::TreeJoints joints(tree_);
  const auto rest = std::get<pose::TreePose>(pose::rest_pose(tree_));
  const pose::TreeKinematicsJob job{.skeleton = &tree_, .pose = &rest, .row = {}, .joints = &joints};
  ASSERT_EQ(job.run(), pose::TreeKinematicsJob::Problem::kNone);
  std::vector<float> all;
  for (std::size_t level = 0; level < tree_.levels.size(); ++level) {
    EXPECT_EQ(first_joint_at(tree_, level), all.size());
    const auto data = std::as_const(joints).level(level).data();
    all.insert(all.end(), data.begin(), data.end());
  }
  EXPECT_EQ(first_joint_at(tree_, tree_.levels.size()), all.size());

  for (std::size_t level = 0; level < tree_.levels.size(); ++level) {
    for (const Part& part : tree_parts(tree_, level)) {
      EXPECT_EQ(part.root_at < 0, level == 0);
      for (std::size_t axis = 0; axis < 3 && part.root_at >= 0; ++axis) {
        const auto at = static_cast<std::size_t>(part.root_at) + axis * pose::kStrandsPerBlock;
        ASSERT_NEAR(all.at(at), part.root_m[axis], 1e-4F);
      }
    }
  }
}

TEST_F(TreePartsTest, AreOneAStrandWithTheLevelsRadii) {
  for (std::size_t level = 0; level < tree_.levels.size(); ++level) {
    const auto parts = tree_parts(tree_, level);
    ASSERT_EQ(parts.size(), tree_.levels[level].strands.strand_count);
    for (std::size_t i = 0; i < parts.size(); ++i) {
      EXPECT_EQ(parts[i].strand, i);
      EXPECT_EQ(parts[i].base_radius_m, tree_.levels[level].base_radius_m[i]);
    }
  }
}

TEST_F(TreePartsTest, LeavesLeadWhereTheyDoAtRestAndFaceTheSkyOrOutOfTheCrown) {
  constexpr std::size_t kLeafLevel = 3;
  pose::TreeJoints joints(tree_);
  const auto rest = std::get<pose::TreePose>(pose::rest_pose(tree_));
  const pose::TreeKinematicsJob job{.skeleton = &tree_, .pose = &rest, .row = {}, .joints = &joints};
  ASSERT_EQ(job.run(), pose::TreeKinematicsJob::Problem::kNone);
  const std::size_t links = tree_.levels[kLeafLevel].strands.links_per_strand;
  const auto leaves = tree_parts(tree_, kLeafLevel);
  std::array<float, 3> middle_m{};
  for (const Part& leaf : leaves) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      middle_m[axis] += leaf.root_m[axis] / static_cast<float>(leaves.size());
    }
  }
  float outward = 0.0F;
  for (const Part& leaf : leaves) {
    const pose::JointPosition tip = joints.level(kLeafLevel).joint(leaf.strand, links - 1);
    const std::array<float, 3> way_m = {tip.x_m - leaf.root_m[0], tip.y_m - leaf.root_m[1], tip.z_m - leaf.root_m[2]};
    const float length_m = std::hypot(way_m[0], way_m[1], way_m[2]);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      EXPECT_NEAR(leaf.rest[axis], way_m[axis] / length_m, 1e-2F);
      outward += leaf.facing[axis] * (leaf.root_m[axis] - middle_m[axis]);
    }
    EXPECT_NEAR(std::hypot(leaf.facing[0], leaf.facing[1], leaf.facing[2]), 1.0F, 1e-5F);
  }
  EXPECT_GT(outward / static_cast<float>(leaves.size()), 0.1F);  // metres out of the middle, on average
}

TEST_F(TreePartsTest, NothingGrowsOnTheBarePartOfABranch) {
  for (std::size_t level = 0; level + 1 < tree_.levels.size(); ++level) {
    const float bare = bare_share(tree_, level);
    const auto links = static_cast<float>(tree_.levels[level].strands.links_per_strand);
    float first = 1.0F;
    for (const pose::TreeLevel& grown : tree_.levels) {
      if (&grown == tree_.levels.data() || grown.parent_level != level) continue;
      for (const auto link : grown.parent_link) first = std::min(first, static_cast<float>(link) / links);
    }
    EXPECT_FLOAT_EQ(bare, first);
  }
  EXPECT_EQ(bare_share(tree_, tree_.levels.size() - 1), 1.0F) << "nothing grows on leaves";
}

TEST_F(TreePartsTest, LeavesHaveTheColorsOfTheirFoliage) {
  for (const Part& leaf : tree_parts(tree_, 3)) EXPECT_GT(leaf.tint[1], leaf.tint[0]) << "green";
  pose::TreeSkeleton tree = tree_;
  tree.foliage = pose::FoliageColor::kAutumn;
  for (const Part& leaf : tree_parts(tree, 3)) EXPECT_GT(leaf.tint[0], leaf.tint[1]);
  tree.foliage = pose::FoliageColor::kBlossom;
  for (const Part& leaf : tree_parts(tree, 3)) EXPECT_GT(leaf.tint[2], 0.2F) << "pale pink";
}

}  // namespace
}  // namespace yuragi::viewer::meshes::trees
