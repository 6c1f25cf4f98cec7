#include "viewer/meshes/bounds.hpp"

#include <gtest/gtest.h>

#include "tests/viewer/test_models.hpp"

namespace yuragi::viewer::meshes {
namespace {

Bounds bounds_of_model(std::string_view kind) {
  return bounds_of(test_model(kind, {10.0, -20.0}).skeleton);
}

TEST(Bounds, OfACurtainHaveRoomToSwing) {
  const Bounds bounds = bounds_of_model("curtain");
  EXPECT_LE(bounds.low_m.x, 10.0F - 1.2F);
  EXPECT_GE(bounds.high_m.x, 10.0F + 1.2F);
  EXPECT_NEAR(bounds.high_m.y, 2.5F, 1e-4F);
  EXPECT_NEAR(bounds.low_m.y, 0.2F, 1e-4F);
  EXPECT_LT(bounds.low_m.z, -20.2F);
  EXPECT_GT(bounds.high_m.z, -19.8F);
}

TEST(Bounds, OfAFlagReachToEverySideOfItsPole) {
  const Bounds bounds = bounds_of_model("flag");
  EXPECT_LT(bounds.low_m.x, 10.0F - 1.4F);
  EXPECT_GT(bounds.high_m.x, 10.0F + 1.4F);
  EXPECT_LT(bounds.low_m.z, -20.0F - 1.4F);
  EXPECT_GT(bounds.high_m.z, -20.0F + 1.4F);
  EXPECT_NEAR(bounds.high_m.y, 4.0F, 1e-4F);
}

TEST(Bounds, OfWaterAndFlameAreTheirSurfaces) {
  EXPECT_NEAR(bounds_of_model("ripple").high_m.x, 12.7F, 0.1F);  // with its rim
  EXPECT_NEAR(bounds_of_model("ripple").high_m.y, 0.0F, 0.1F);
  EXPECT_NEAR(bounds_of_model("flame").high_m.y, 1.7F, 0.1F);
}

TEST(Bounds, OfNothingAreNothing) {
  for (const pose::Skeleton& skeleton :
       {pose::Skeleton(pose::StrandSkeleton{}), pose::Skeleton(pose::GridSkeleton{}),
        pose::Skeleton(pose::TreeSkeleton{}), pose::Skeleton(pose::SurfaceSkeleton{})}) {
    EXPECT_EQ(bounds_of(skeleton).low_m, glm::vec3(0.0F));
    EXPECT_EQ(bounds_of(skeleton).high_m, glm::vec3(0.0F));
  }
}

TEST(Bounds, UnitedHoldBoth) {
  const Bounds both = united({{0, 0, 0}, {1, 1, 1}}, {{-1, 0.5F, 2}, {0, 3, 4}});
  EXPECT_EQ(both.low_m, glm::vec3(-1, 0, 0));
  EXPECT_EQ(both.high_m, glm::vec3(1, 3, 4));
}

}  // namespace
}  // namespace yuragi::viewer::meshes
