#include "viewer/meshes/trees/crown.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "engine/pose/pose_arrays.hpp"
#include "tests/viewer/test_models.hpp"
#include "viewer/meshes/trees/branches.hpp"

namespace yuragi::viewer::meshes::trees {
namespace {

class CrownTest : public testing::Test {
 protected:
  static constexpr std::size_t kLeafLevel = 3;

  CrownTest() {
    const auto rest = std::get<pose::TreePose>(pose::rest_pose(tree_));
    const pose::TreeKinematicsJob job{.skeleton = &tree_, .pose = &rest, .row = {}, .joints = &joints_};
    EXPECT_EQ(job.run(), pose::TreeKinematicsJob::Problem::kNone);
    crown_.move_to(joints_);
  }

  static View view_at(const glm::dvec3& target_m, double distance_m, double heading_deg = 0.0) {
    OrbitCamera camera;
    camera.frame({target_m, heading_deg, 5.0, distance_m});
    return view_of(camera, 1280, 720);
  }
  glm::dvec3 middle_m() const {
    const Bounds bounds = bounds_of(tree_);
    return glm::dvec3(bounds.low_m + bounds.high_m) / 2.0;
  }
  /// The leaf area that is drawn, in leaves of full size.
  float drawn() const {
    float sum = 0.0F;
    for (const SprayPlace& spray : crown_.places()) {
      const float whole = std::floor(spray.leaves);
      const float part = spray.leaves - whole;
      sum += (whole + part * part) * spray.size * spray.size;
    }
    return sum;
  }
  float all() const {
    return static_cast<float>(tree_.levels[kLeafLevel].strands.strand_count * crown_.shape().leaves);
  }

  const pose::TreeSkeleton tree_ = std::get<pose::TreeSkeleton>(test_model("tree").skeleton);
  pose::TreeJoints joints_{tree_};
  Crown crown_{tree_, kLeafLevel};
};

TEST_F(CrownTest, SpraysLeadFromTheirTwigsToTheirTips) {
  crown_.choose(view_at(middle_m(), 15.0), {});
  ASSERT_EQ(crown_.places().size(), tree_.levels[kLeafLevel].strands.strand_count);
  const std::size_t links = tree_.levels[kLeafLevel].strands.links_per_strand;
  for (const SprayPlace& spray : crown_.places()) {
    const auto strand = static_cast<std::size_t>(spray.number);
    const pose::JointPosition tip = joints_.level(kLeafLevel).joint(strand, links - 1);
    EXPECT_LT(glm::distance(spray.tip_m, glm::vec3(tip.x_m, tip.y_m, tip.z_m)), 1e-5F);
    const glm::vec3 root_m(tree_.levels[kLeafLevel].strands.root_x_m[strand],
                           tree_.levels[kLeafLevel].strands.root_y_m[strand],
                           tree_.levels[kLeafLevel].strands.root_z_m[strand]);
    EXPECT_LT(glm::distance(spray.root_m, root_m), 1e-3F);
    EXPECT_NEAR(glm::length(spray.upper), 1.0F, 1e-3F);
    EXPECT_LT(spray.blown, 1e-3F) << "at rest";
  }
}

TEST_F(CrownTest, GroupsHoldEachSprayOnceWithAMeshThatSuffices) {
  for (const double distance_m : {1.0, 4.0, 10.0, 25.0, 60.0, 150.0}) {
    crown_.choose(view_at(middle_m(), distance_m), {});
    std::size_t next = 0;
    for (const SprayGroup& group : crown_.groups()) {
      EXPECT_EQ(group.first, next);
      next += group.count;
      for (std::size_t i = group.first; i < next; ++i) {
        EXPECT_LE(crown_.places()[i].leaves, static_cast<float>(group.leaves));
        EXPECT_GT(crown_.places()[i].leaves, 0.0F);
      }
    }
    EXPECT_EQ(next, crown_.places().size());
    std::map<float, int> times;
    for (const SprayPlace& spray : crown_.places()) EXPECT_EQ(++times[spray.number], 1);
  }
}

TEST_F(CrownTest, FromFartherAwayFewerLeavesCoverAboutTheSame) {
  std::size_t before = tree_.levels[kLeafLevel].strands.strand_count;
  for (const double distance_m : {15.0, 30.0, 60.0, 120.0, 200.0}) {
    crown_.choose(view_at(middle_m(), distance_m), {.leaf_px = 8.0F, .largest = 10.0F});
    EXPECT_NEAR(drawn() / all(), 1.0F, 0.25F) << distance_m;
    EXPECT_LE(crown_.places().size(), before);
    before = crown_.places().size();
  }
  EXPECT_LT(before, tree_.levels[kLeafLevel].strands.strand_count);
}

TEST_F(CrownTest, SpraysOutOfViewAreLeftOut) {
  crown_.choose(view_at(middle_m(), 15.0), {});
  const std::size_t all = crown_.places().size();
  crown_.choose(view_at(middle_m() + glm::dvec3(0.0, 0.0, -40.0), 10.0), {});
  EXPECT_EQ(crown_.places().size(), 0U) << "behind the camera";
  crown_.choose(view_at(middle_m(), 0.3), {});
  EXPECT_LT(crown_.places().size(), all / 2) << "from inside of the crown";
}

TEST_F(CrownTest, ShownBareItHasStiffTwigsInThePlaceOfItsLeaves) {
  Crown bare(tree_, kLeafLevel, pose::FoliageColor::kBare);
  EXPECT_EQ(bare.shape().kind, SprayShape::Kind::kTwigs);
  // The wind turns the leaves alone.
  auto blown = std::get<pose::TreePose>(pose::rest_pose(tree_));
  std::ranges::fill(blown.levels[kLeafLevel].bend_east_rad, 0.8F);
  const pose::TreeKinematicsJob job{.skeleton = &tree_, .pose = &blown, .row = {}, .joints = &joints_};
  bare.move_to(joints_);
  bare.choose(view_at(middle_m(), 8.0), {});
  const std::vector<SprayPlace> before(bare.places().begin(), bare.places().end());
  EXPECT_LT(crown_.blown(), 1e-3F) << "at rest";
  ASSERT_EQ(job.run(), pose::TreeKinematicsJob::Problem::kNone);
  bare.move_to(joints_);
  crown_.move_to(joints_);
  EXPECT_GT(crown_.blown(), 0.05F);
  bare.choose(view_at(middle_m(), 8.0), {});
  ASSERT_EQ(bare.places().size(), before.size());
  for (std::size_t i = 0; i < before.size(); ++i) {
    EXPECT_LT(glm::distance(before[i].tip_m, bare.places()[i].tip_m), 1e-4F);
    EXPECT_NEAR(glm::distance(before[i].root_m, before[i].tip_m), before[i].length_m, 1e-3F);
  }
}

TEST_F(CrownTest, ACopyStandsTurnedAndScaledAtItsPlace) {
  const Place place{
      .from_m = {0.0F, 0.0F, 0.0F}, .to_m = {30.0F, 0.0F, 5.0F}, .cosine = 0.6F, .sine = 0.8F, .scale = 0.5F};
  EXPECT_LT(glm::distance(place.moved({1.0F, 2.0F, 0.0F}), glm::vec3(30.3F, 1.0F, 5.4F)), 1e-5F);
  crown_.choose(view_at({30.0, 1.0, 5.0}, 15.0), {});
  EXPECT_TRUE(crown_.places().empty());
  crown_.choose(view_at({30.0, 1.0, 5.0}, 15.0), {}, place);
  ASSERT_FALSE(crown_.places().empty());
  const pose::StrandSkeleton& leaves = tree_.levels[kLeafLevel].strands;
  for (const SprayPlace& spray : crown_.places()) {
    const auto strand = static_cast<std::size_t>(spray.number);
    const glm::vec3 root_m(leaves.root_x_m[strand], leaves.root_y_m[strand], leaves.root_z_m[strand]);
    EXPECT_LT(glm::distance(spray.root_m, place.moved(root_m)), 1e-3F);
  }
}

TEST_F(CrownTest, LightComesFromOutsideOfTheCrownAndLessToItsMiddle) {
  pose::TreeSkeleton dense = tree_;
  for (float& length_m : dense.levels[kLeafLevel].strands.link_length_m) length_m *= 6.0F;
  const std::vector<glm::vec4> open = crown_openness(dense, kLeafLevel, crown_.shape());
  const pose::StrandSkeleton& leaves = dense.levels[kLeafLevel].strands;
  glm::vec3 middle(0.0F);
  for (std::size_t i = 0; i < open.size(); ++i) {
    middle += glm::vec3(leaves.root_x_m[i], leaves.root_y_m[i], leaves.root_z_m[i]) / static_cast<float>(open.size());
  }
  float outward = 0.0F;
  for (std::size_t i = 0; i < open.size(); ++i) {
    const glm::vec3 from_middle = glm::vec3(leaves.root_x_m[i], leaves.root_y_m[i], leaves.root_z_m[i]) - middle;
    outward += glm::dot(glm::vec3(open[i]), from_middle);
    EXPECT_GE(open[i].w, 0.0F);
    EXPECT_LE(open[i].w, 1.0F);
  }
  EXPECT_GT(outward, 0.0F);
}

TEST_F(CrownTest, ACrownThatIsFarTooFarOffIsMadeAllTheSame) {
  // As a stream may send it: there no step of light through the leaves changes a place.
  pose::TreeSkeleton tree = tree_;
  for (float& x_m : tree.levels[kLeafLevel].strands.root_x_m) x_m = 1e6F;
  const std::vector<glm::vec4> open = crown_openness(tree, kLeafLevel, spray_shape(tree));
  EXPECT_EQ(open.size(), tree.levels[kLeafLevel].strands.strand_count);
  for (const glm::vec4& light : open) EXPECT_TRUE(light.w >= 0.0F && light.w <= 1.0F) << light.w;
}

TEST_F(CrownTest, SpraysThatOthersHideFromTheEyeHaveFewerLeaves) {
  pose::TreeSkeleton dense = tree_;
  for (float& length_m : dense.levels[kLeafLevel].strands.link_length_m) length_m *= 6.0F;
  Crown crown(dense, kLeafLevel);
  crown.move_to(joints_);
  const auto leaves = [&](float hidden_share) {
    crown.choose(view_at(middle_m(), 15.0), {.shaped_leaf_px = 1e3F, .hidden_share = hidden_share});
    float sum = 0.0F;
    for (const SprayPlace& spray : crown.places()) sum += spray.leaves;
    return sum;
  };
  const float all = leaves(1.0F);
  EXPECT_LT(leaves(0.3F), 0.95F * all);
  EXPECT_GT(leaves(0.3F), 0.3F * all) << "those in front have all of theirs";
}

TEST_F(CrownTest, BranchesHaveMoreRingsTheNearerTheyAreAndNoMoreThanLinks) {
  for (std::size_t level = 0; level < kLeafLevel; ++level) {
    Branches branches(tree_, level);
    branches.move_to(joints_);
    const std::size_t links = tree_.levels[level].strands.links_per_strand;
    std::size_t before = links;
    for (const double distance_m : {0.5, 5.0, 20.0, 80.0, 200.0}) {
      branches.choose(view_at(middle_m(), distance_m), 5.0F);
      std::size_t most = 0;
      std::size_t next = 0;
      for (const BranchGroup& group : branches.groups()) {
        EXPECT_LE(group.rings, links);
        EXPECT_EQ(group.first, next);
        next += group.count;
        if (group.count > 0) most = std::max(most, group.rings);
      }
      EXPECT_EQ(next, branches.parts().size());
      EXPECT_LE(most, before);
      before = most;
    }
    EXPECT_LE(before, std::min(2 * Branches::kMinRings, links));
    branches.choose(view_at(middle_m() + glm::dvec3(0.0, 0.0, -60.0), 10.0), 5.0F);
    EXPECT_TRUE(branches.parts().empty()) << "behind the camera";
  }
}

}  // namespace
}  // namespace yuragi::viewer::meshes::trees
