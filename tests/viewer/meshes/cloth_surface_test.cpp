#include "viewer/meshes/cloth_surface.hpp"

#include <cmath>

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <gtest/gtest.h>

namespace yuragi::viewer::meshes {
namespace {

constexpr GridLayout kJoints{9, 7, 16, false};
constexpr float kRadius_m = 0.5F;
constexpr ClothMeasure kLies{{0.0F, 0.0F}, {0.1F, 0.0F}, {0.0F, 0.2F}, {0.8F, 1.2F}};

/// Cloth around a part of an upright cylinder, hollow toward +z; its joints' padding is far away.
std::vector<float> around_a_cylinder() {
  std::vector<float> joints(3 * kJoints.size(), 1e6F);
  for (std::size_t row = 0; row < kJoints.rows; ++row) {
    for (std::size_t column = 0; column < kJoints.columns; ++column) {
      const float angle_rad = 0.1F * (static_cast<float>(column) - 4.0F) / kRadius_m;
      const std::size_t i = row * kJoints.stride + column;
      joints[i] = kRadius_m * std::sin(angle_rad);
      joints[kJoints.size() + i] = -0.2F * static_cast<float>(row);
      joints[2 * kJoints.size() + i] = -kRadius_m * std::cos(angle_rad);
    }
  }
  return joints;
}

glm::vec3 place_of(std::span<const float> of, std::size_t count, std::size_t i) {
  return {of[i], of[count + i], of[2 * count + i]};
}

TEST(ClothSurface, IsSmoothBetweenTheJointsAndPassesThroughThem) {
  const std::vector<float> joints = around_a_cylinder();
  ClothSurface surface(kJoints, 2);
  surface.move_to(joints);
  const GridLayout& fine = surface.layout();
  ASSERT_EQ(fine.columns, 33U);
  ASSERT_EQ(fine.rows, 25U);
  for (std::size_t row = 0; row < fine.rows; ++row) {
    for (std::size_t column = 0; column < fine.columns; ++column) {
      const glm::vec3 at = place_of(surface.points(), fine.size(), row * fine.columns + column);
      EXPECT_NEAR(at.y, -0.05F * static_cast<float>(row), 1e-4F);
      // A chord between two joints would be 2.5 mm inside; the spline is within 0.1 mm, but for its ends.
      const bool is_at_end = column < 4 || column + 4 >= fine.columns;
      EXPECT_NEAR(std::hypot(at.x, at.z), kRadius_m, is_at_end ? 2e-3F : 1e-4F);
      if (row % 4 == 0 && column % 4 == 0) {
        const std::size_t joint = row / 4 * kJoints.stride + column / 4;
        EXPECT_LT(glm::distance(at, place_of(joints, kJoints.size(), joint)), 1e-5F);
      }
    }
  }
}

TEST(ClothSurface, KeepsItsCornersWhereThereAreFewerPointsThanJoints) {
  const std::vector<float> joints = around_a_cylinder();
  ClothSurface surface(kJoints, -1);
  surface.move_to(joints);
  const GridLayout& coarse = surface.layout();
  ASSERT_EQ(coarse.columns, 5U);
  const std::size_t last = coarse.size() - 1;
  EXPECT_LT(glm::distance(place_of(surface.points(), coarse.size(), last),
                          place_of(joints, kJoints.size(), 6 * kJoints.stride + 8)),
            1e-5F);
  const std::vector<float> places_m = surface.places_m(kLies);
  EXPECT_NEAR(places_m[last], 0.8F, 1e-5F);
  EXPECT_NEAR(places_m[coarse.size() + last], 1.2F, 1e-5F);
}

TEST(ClothSurface, SaysOnWhichSideItIsHollow) {
  ClothSurface surface(kJoints, 2);
  surface.move_to(around_a_cylinder());
  std::vector<float> bends_per_m(surface.layout().size());
  surface.write_bends(0.05F, kLies, bends_per_m);
  const std::size_t middle = surface.layout().size() / 2;
  const float toward = place_of(surface.normals(), surface.layout().size(), middle).z;
  EXPECT_NEAR(bends_per_m[middle] * toward, 1.0F / kRadius_m, 0.05F);
}

TEST(ClothSurface, HasARimAsThickAsItIs) {
  ClothSurface surface(kJoints, 0);
  surface.move_to(around_a_cylinder());
  const std::size_t around = surface.rim().size();
  ASSERT_EQ(around, 2U * (8 + 6) + 1);
  EXPECT_EQ(surface.rim().front(), surface.rim().back());
  std::vector<float> points(6 * around);
  std::vector<float> normals(6 * around);
  surface.write_rim(0.002F, points, normals);
  for (std::size_t i = 0; i < around; ++i) {
    const glm::vec3 front = place_of(points, 2 * around, 2 * i);
    const glm::vec3 back = place_of(points, 2 * around, 2 * i + 1);
    EXPECT_NEAR(glm::distance(front, back), 0.004F, 1e-5F);
    // Its normals point away from the cloth's middle, which is on the axis' level half way down.
    const glm::vec3 out = place_of(normals, 2 * around, 2 * i) + place_of(normals, 2 * around, 2 * i + 1);
    EXPECT_GT(glm::dot(out, (front + back) / 2.0F - glm::vec3(0.0F, -0.6F, -kRadius_m)), 0.0F) << i;
  }
}

TEST(ClothSurface, HasNoMorePointsThanAllowed) {
  const ClothSurface surface({1000, 1000, 1008, false}, 2);
  EXPECT_LE(surface.layout().size(), ClothSurface::kMaxPoints);
  EXPECT_GT(surface.layout().size(), 1U);
  ClothSurface none({}, 0);
  none.move_to({});
  EXPECT_TRUE(none.points().empty());
  ClothSurface line({1, 5, 16, false}, 1);
  line.move_to(std::vector<float>(3 * 80));
  EXPECT_TRUE(line.rim().empty());
}

}  // namespace
}  // namespace yuragi::viewer::meshes
