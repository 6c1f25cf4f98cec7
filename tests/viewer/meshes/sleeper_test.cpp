#include "viewer/meshes/sleeper.hpp"

#include <cmath>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "engine/base/units.hpp"

namespace yuragi::viewer::meshes {
namespace {

/// Half an ellipsoid of roots on the ground, whose hairs lie toward -x before it is turned about the vertical.
pose::StrandSkeleton coat_of(const glm::vec3& half_m, float turn_rad) {
  pose::StrandSkeleton coat;
  const auto turned = [turn_rad](float x, float z) {
    return glm::vec2(std::cos(turn_rad) * x - std::sin(turn_rad) * z, std::sin(turn_rad) * x + std::cos(turn_rad) * z);
  };
  for (int ring = 0; ring <= 20; ++ring) {
    const float up = static_cast<float>(ring) / 20.0F;
    for (int i = 0; i < 30; ++i) {
      const float bearing_rad = static_cast<float>(2.0 * kPi) * static_cast<float>(i) / 30.0F;
      const float level = std::sqrt(1.0F - up * up);
      const glm::vec2 root = turned(half_m.x * level * std::cos(bearing_rad), half_m.z * level * std::sin(bearing_rad));
      coat.root_x_m.push_back(root.x);
      coat.root_y_m.push_back(half_m.y * up);
      coat.root_z_m.push_back(root.y);
      const glm::vec2 lie = turned(-0.8F, 0.0F);
      coat.rest_x.push_back(lie.x);
      coat.rest_y.push_back(0.6F);
      coat.rest_z.push_back(lie.y);
    }
  }
  coat.strand_count = coat.root_x_m.size();
  return coat;
}

Limbs limbs_on(const glm::vec3& half_m, float turn_rad) {
  const pose::StrandSkeleton coat = coat_of(half_m, turn_rad);
  return limbs_of(coat, body_of(coat));
}

TEST(Sleeper, HasItsHeadWhereTheHairsLieAwayFrom) {
  for (const float turn_rad : {0.0F, 0.7F, 3.0F}) {
    const Limbs limbs = limbs_on({0.55F, 0.5F, 0.25F}, turn_rad);
    ASSERT_FALSE(limbs.vertices.empty());
    const glm::vec3 ahead(std::cos(turn_rad), 0.0F, std::sin(turn_rad));
    float front_m = 0.0F;
    float back_m = 0.0F;
    for (const LimbVertex& vertex : limbs.vertices) {
      front_m = std::max(front_m, glm::dot(vertex.place_m, ahead));
      back_m = std::max(back_m, -glm::dot(vertex.place_m, ahead));
    }
    EXPECT_GT(front_m, 0.8F);  // the nose, well beyond the body
    EXPECT_LT(back_m, 0.75F);  // the tail is curled
  }
}

TEST(Sleeper, LiesOnTheGroundAndNotInIt) {
  for (const LimbVertex& vertex : limbs_on({0.55F, 0.5F, 0.25F}, 0.4F).vertices) {
    EXPECT_GT(vertex.place_m.y, -0.03F);
    EXPECT_LT(vertex.place_m.y, 0.5F);
    EXPECT_NEAR(glm::length(vertex.normal), 1.0F, 1e-3F);
  }
}

TEST(Sleeper, HasTrianglesOfItsVertices) {
  const Limbs limbs = limbs_on({0.55F, 0.5F, 0.25F}, 0.0F);
  EXPECT_EQ(limbs.indices.size() % 3, 0U);
  for (const std::uint32_t index : limbs.indices) ASSERT_LT(index, limbs.vertices.size());
}

TEST(Sleeper, HasAShortCoatOnItsLimbs) {
  const Limbs limbs = limbs_on({0.55F, 0.5F, 0.25F}, 0.4F);
  ASSERT_GT(limbs.indices.size(), limbs.skin_count);
  ASSERT_EQ((limbs.indices.size() - limbs.skin_count) % 3, 0U);
  std::size_t out = 0;
  for (std::size_t i = limbs.skin_count; i < limbs.indices.size(); i += 3) {
    const LimbVertex& foot = limbs.vertices[limbs.indices[i]];
    const LimbVertex& tip = limbs.vertices[limbs.indices[i + 2]];
    const glm::vec3 way_m = tip.place_m - foot.place_m;
    EXPECT_LT(glm::length(way_m), 1.1F * limbs.hair_m);
    out += glm::dot(way_m, foot.normal) > 0.0F ? 1U : 0U;
  }
  EXPECT_EQ(out, (limbs.indices.size() - limbs.skin_count) / 3);
  EXPECT_LT(limbs.hair_m, 0.09F);  // no longer than the coat's
}

/// From afar only the first of them are drawn.
TEST(Sleeper, HasTheFirstOfItsHairsAllOverItsLimbs) {
  const Limbs limbs = limbs_on({0.55F, 0.5F, 0.25F}, 0.4F);
  const auto middle_m = [&](std::size_t hairs) {
    glm::vec3 sum_m(0.0F);
    for (std::size_t i = 0; i < hairs; ++i) sum_m += limbs.vertices[limbs.indices[limbs.skin_count + 3 * i]].place_m;
    return sum_m / static_cast<float>(hairs);
  };
  const std::size_t all = (limbs.indices.size() - limbs.skin_count) / 3;
  for (const std::size_t part : {64U, 16U, 2U}) {
    EXPECT_LT(glm::distance(middle_m(all / part), middle_m(all)), 0.02F) << "1/" << part;
  }
  const LimbVertex& left = limbs.vertices[limbs.indices[limbs.skin_count]];
  const LimbVertex& right = limbs.vertices[limbs.indices[limbs.skin_count + 1]];
  EXPECT_LT(glm::distance(left.place_m - left.aside_m, right.place_m - right.aside_m), 1e-5F) << "both about one line";
}

TEST(Sleeper, IsNoBackThatFillsThePicture) {
  EXPECT_TRUE(limbs_on({1.5F, 0.75F, 1.0F}, 0.0F).indices.empty());
  EXPECT_TRUE(limbs_of({}, body_of({})).indices.empty());
}

}  // namespace
}  // namespace yuragi::viewer::meshes
