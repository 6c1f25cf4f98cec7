#include "viewer/meshes/trees/sprays.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include <gtest/gtest.h>

#include "tests/viewer/test_models.hpp"

namespace yuragi::viewer::meshes::trees {
namespace {

class SpraysTest : public testing::Test {
 protected:
  /// The test's tree, with leaf strands of these proportions.
  static pose::TreeSkeleton tree_of(float length_m, float width_m) {
    pose::TreeSkeleton tree = std::get<pose::TreeSkeleton>(test_model("tree").skeleton);
    pose::TreeLevel& leaves = tree.levels.back();
    std::ranges::fill(leaves.strands.link_length_m, length_m / static_cast<float>(leaves.strands.links_per_strand));
    std::ranges::fill(leaves.base_radius_m, 0.5F * width_m);
    return tree;
  }
  static float area(const SprayMesh& mesh) {
    float sum = 0.0F;
    for (std::size_t i = mesh.stalk_indices; i + 2 < mesh.triangles.size(); i += 3) {
      const SprayCorner& a = mesh.corners.at(mesh.triangles[i]);
      const SprayCorner& b = mesh.corners.at(mesh.triangles[i + 1]);
      const SprayCorner& c = mesh.corners.at(mesh.triangles[i + 2]);
      sum += 0.5F * std::abs((b.along - a.along) * (c.across - a.across) - (c.along - a.along) * (b.across - a.across));
    }
    return sum;
  }
};

TEST_F(SpraysTest, LeavesHaveTheSizeAndTheProportionsOfTheSpecies) {
  // The strands of the engine's species: cherry, zelkova, poplar.
  const SprayShape cherry = spray_shape(tree_of(0.28F, 0.14F));
  EXPECT_NEAR(0.28F * cherry.leaf_length, 0.08F, 0.01F);
  EXPECT_NEAR(cherry.leaf_width, 0.5F, 0.05F);
  const SprayShape zelkova = spray_shape(tree_of(0.28F, 0.112F));
  EXPECT_NEAR(0.28F * zelkova.leaf_length, 0.065F, 0.01F);
  EXPECT_LT(zelkova.leaf_width, cherry.leaf_width);
  const SprayShape poplar = spray_shape(tree_of(0.26F, 0.195F));
  EXPECT_NEAR(0.26F * poplar.leaf_length, 0.06F, 0.01F);
  EXPECT_GT(poplar.leaf_width, 1.0F) << "wider than long";
}

TEST_F(SpraysTest, ABlossomingTreeHasFlowersOfThreeCentimetres) {
  pose::TreeSkeleton tree = tree_of(0.28F, 0.14F);
  tree.foliage = pose::FoliageColor::kBlossom;
  const SprayShape shape = spray_shape(tree);
  EXPECT_TRUE(shape.has_flowers());
  EXPECT_NEAR(0.28F * shape.leaf_length, 0.03F, 0.003F);
}

TEST_F(SpraysTest, MeshesAreWholeAndCoverTheSameNearAndFar) {
  for (const auto foliage : {pose::FoliageColor::kGreen, pose::FoliageColor::kBlossom}) {
    for (const float width_m : {0.10F, 0.14F, 0.20F}) {
      pose::TreeSkeleton tree = tree_of(0.28F, width_m);
      tree.foliage = foliage;
      const SprayShape shape = spray_shape(tree);
      const SprayMesh near = near_spray(shape);
      const SprayMesh far = far_spray(shape);
      const SprayMesh speck = speck_spray(shape);
      for (const SprayMesh* mesh : {&near, &far, &speck}) {
        EXPECT_EQ(mesh->triangles.size(), mesh->stalk_indices + shape.leaves * mesh->leaf_indices);
        for (const std::uint32_t corner : mesh->triangles) ASSERT_LT(corner, mesh->corners.size());
        for (std::size_t i = mesh->stalk_indices; i < mesh->triangles.size(); ++i) {
          const std::size_t leaf = (i - mesh->stalk_indices) / mesh->leaf_indices;
          EXPECT_EQ(mesh->corners[mesh->triangles[i]].leaf, static_cast<float>(leaf));
        }
      }
      EXPECT_NEAR(area(far) / area(near), 1.0F, 0.2F) << width_m;
      EXPECT_NEAR(area(speck) / area(far), 1.0F, 0.05F) << width_m;
      EXPECT_LT(far.triangles.size(), near.triangles.size());
      EXPECT_EQ(speck.triangles.size(), 3 * shape.leaves);
    }
  }
}

TEST_F(SpraysTest, LeavesAreSpreadAlongTheStrandAtBothSides) {
  const SprayMesh mesh = far_spray(spray_shape(tree_of(0.28F, 0.14F)));
  std::set<float> places;
  std::set<float> sides;
  for (const SprayCorner& corner : mesh.corners) {
    EXPECT_GT(corner.at, 0.1F);
    EXPECT_LE(corner.at, 1.0F);
    places.insert(corner.at);
    sides.insert(corner.side);
  }
  EXPECT_GE(places.size(), 5U);
  EXPECT_EQ(sides, (std::set<float>{-1.0F, 0.0F, 1.0F}));
}

TEST_F(SpraysTest, FartherOnesAreFewerAndLargerLeavesThatCoverTheSame) {
  const SprayShape shape = spray_shape(tree_of(0.28F, 0.14F));
  const SprayDetail detail;
  const auto all = static_cast<float>(shape.leaves);
  float before = all;
  for (float leaf_px = 60.0F; leaf_px > 0.1F; leaf_px /= 1.02F) {
    const SprayLevel level = spray_level(shape, leaf_px, detail);
    EXPECT_LE(level.leaves, before);
    EXPECT_GT(level.leaves, before - 0.05F * all) << "they go smoothly";
    EXPECT_NEAR(level.leaves * level.size * level.size, all, 0.01F);
    EXPECT_EQ(level.kind == SprayKind::kNear, leaf_px > detail.shaped_leaf_px);
    before = level.leaves;
  }
  EXPECT_EQ(spray_level(shape, 60.0F, detail).leaves, all);
  EXPECT_EQ(spray_level(shape, 0.0F, detail).size, detail.largest) << "no larger, however far away";
  EXPECT_EQ(spray_level(shape, INFINITY, detail).leaves, all);
}

TEST_F(SpraysTest, ABareTreeHasTwigsThatGrowThin) {
  pose::TreeSkeleton tree = tree_of(0.28F, 0.14F);
  tree.foliage = pose::FoliageColor::kBare;
  const SprayShape shape = spray_shape(tree);
  EXPECT_EQ(shape.kind, SprayShape::Kind::kTwigs);
  const SprayMesh mesh = far_spray(shape);
  ASSERT_EQ(mesh.triangles.size(), shape.leaves * mesh.leaf_indices);
  // The first is the spray's own axis, all of it.
  EXPECT_EQ(mesh.corners.front().at, 0.0F);
  EXPECT_EQ(mesh.corners[mesh.triangles[mesh.leaf_indices - 1]].at, 1.0F);
  for (const SprayCorner& corner : mesh.corners) {
    EXPECT_EQ(std::abs(corner.across), 1.0F);
    EXPECT_GT(corner.edge, 0.0F) << "its thickness";
    EXPECT_LE(corner.edge, corner.leaf > 0.0F ? 0.7F : 1.0F);
  }
}

TEST_F(SpraysTest, ATreeWithoutLeavesHasAShapeToo) {
  EXPECT_GT(spray_shape(pose::TreeSkeleton{}).leaves, 0U);
  EXPECT_EQ(mean_length_m(pose::StrandSkeleton{}), 0.0F);
}

}  // namespace
}  // namespace yuragi::viewer::meshes::trees
