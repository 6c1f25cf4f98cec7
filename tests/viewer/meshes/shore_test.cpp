#include "viewer/meshes/shore.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "tests/viewer/test_models.hpp"
#include "viewer/meshes/ground_map.hpp"

namespace yuragi::viewer::meshes {
namespace {

constexpr float kAllRound_rad = 6.2831853F;

/// A level grid whose sides are turned by an angle.
pose::SurfaceSkeleton pond(float width_m, float depth_m, float turn_rad = 0.0F, std::size_t columns = 41,
                           std::size_t rows = 31) {
  pose::SurfaceSkeleton surface;
  surface.columns = columns;
  surface.rows = rows;
  for (std::size_t i = 0; i < columns * rows; ++i) {
    const float x = width_m * (static_cast<float>(i % columns) / static_cast<float>(columns - 1) - 0.5F);
    const float z = depth_m * (static_cast<float>(i / columns) / static_cast<float>(rows - 1) - 0.5F);
    surface.rest_x_m.push_back(10.0F + std::cos(turn_rad) * x - std::sin(turn_rad) * z);
    surface.rest_y_m.push_back(0.0F);
    surface.rest_z_m.push_back(-4.0F + std::sin(turn_rad) * x + std::cos(turn_rad) * z);
  }
  return surface;
}

TEST(Shore, LiesWithinTheGridAndFollowsNoRectangle) {
  for (const float turn_rad : {0.0F, 0.7F}) {
    for (const glm::vec2 sides_m : {glm::vec2(8.0F, 8.0F), glm::vec2(7.0F, 5.0F), glm::vec2(30.0F, 12.0F)}) {
      const Shore shore(pond(sides_m.x, sides_m.y, turn_rad));
      ASSERT_TRUE(shore.is_pond());
      float nearest = 10.0F;
      float farthest = 0.0F;
      for (float bearing_rad = 0.0F; bearing_rad < kAllRound_rad; bearing_rad += 0.01F) {
        const glm::vec2 at_m = shore.at(bearing_rad, 0.0F);
        EXPECT_NEAR(shore.out_m(at_m), 0.0F, 1e-3F);
        EXPECT_NEAR(shore.out_m(shore.at(bearing_rad, 0.3F)), 0.3F, 2e-3F);
        const glm::vec2 off_m = at_m - shore.middle_m();
        const float along = std::abs(glm::dot(off_m, shore.along())) / shore.half_m().x;
        const float across = std::abs(glm::dot(off_m, shore.across())) / shore.half_m().y;
        EXPECT_LT(std::max(along, across), 1.0F);
        nearest = std::min(nearest, std::max(along, across));
        farthest = std::max(farthest, std::max(along, across));
      }
      EXPECT_GT(nearest, 0.5F);
      EXPECT_GT(farthest, 1.25F * nearest);
    }
  }
}

TEST(Shore, GoesDownFromTheGroundIntoTheWaterWithoutAStep) {
  const Shore shore(pond(8.0F, 8.0F));
  for (float bearing_rad = 0.0F; bearing_rad < kAllRound_rad; bearing_rad += 0.1F) {
    const float bank_m = shore.bank_m(shore.at(bearing_rad, 0.0F));
    float before_m = shore.bed_m(shore.at(bearing_rad, 0.98F * bank_m));
    EXPECT_NEAR(before_m, 0.0F, 0.02F);
    for (float out_m = 0.98F * bank_m; out_m > -2.5F; out_m -= 0.02F) {
      const float bed_m = shore.bed_m(shore.at(bearing_rad, out_m));
      EXPECT_LE(bed_m, before_m + 1e-4F) << out_m;
      EXPECT_GT(bed_m, before_m - 0.03F) << out_m;
      before_m = bed_m;
    }
    EXPECT_NEAR(shore.bed_m(shore.at(bearing_rad, 0.0F)), -Shore::kSunk_m, 1e-3F);
    EXPECT_LT(before_m, -0.6F);
  }
}

TEST(Shore, IsNoneWhereTheSurfaceHasNoArea) {
  EXPECT_FALSE(Shore().is_pond());
  EXPECT_FALSE(Shore(pose::SurfaceSkeleton{}).is_pond());
  EXPECT_FALSE(Shore(pond(0.0F, 3.0F)).is_pond());
  EXPECT_TRUE(bank_of(Shore()).vertices.empty());
  EXPECT_TRUE(reeds_of(Shore()).empty());
}

TEST(BankMesh, IsSoundAndItsHoleCoversTheWater) {
  const Shore shore(pond(7.0F, 5.0F, 0.4F));
  const BankMesh mesh = bank_of(shore);
  for (const auto* indices : {&mesh.hole, &mesh.bank}) {
    ASSERT_EQ(indices->size() % 3, 0U);
    for (const std::uint32_t i : *indices) ASSERT_LT(i, mesh.vertices.size());
  }
  for (const BankVertex& vertex : mesh.vertices) {
    EXPECT_NEAR(glm::length(vertex.normal), 1.0F, 1e-4F);
    EXPECT_LE(vertex.place_m.y, 0.0F);
  }
  // Its area, from above, is that within the outer edge: more than the water's.
  double area_m2 = 0.0;
  for (std::size_t i = 0; i < mesh.hole.size(); i += 3) {
    const glm::vec3 a = mesh.vertices[mesh.hole[i]].place_m;
    const glm::vec3 b = mesh.vertices[mesh.hole[i + 1]].place_m - a;
    const glm::vec3 c = mesh.vertices[mesh.hole[i + 2]].place_m - a;
    area_m2 += 0.5 * static_cast<double>(b.x * c.z - b.z * c.x);
  }
  EXPECT_GT(area_m2, 0.6 * 35.0);
  EXPECT_LT(area_m2, 1.1 * 35.0);
}

TEST(Reeds, StandAtTheShoreInSomePlacesOnly) {
  const Shore shore(pond(8.0F, 8.0F));
  const std::vector<Reed> reeds = reeds_of(shore);
  EXPECT_GT(reeds.size(), 300U);
  std::array<int, 24> sectors{};
  for (const Reed& reed : reeds) {
    const glm::vec2 at_m(reed.root_m.x, reed.root_m.z);
    EXPECT_LT(std::abs(shore.out_m(at_m)), 0.6F);
    EXPECT_LT(reed.length_m, 1.3F);
    const float bearing_rad = std::atan2(at_m.y + 4.0F, at_m.x - 10.0F) + 0.5F * kAllRound_rad;
    ++sectors[std::min<std::size_t>(static_cast<std::size_t>(24.0F * bearing_rad / kAllRound_rad), 23)];
  }
  EXPECT_GT(std::ranges::count(sectors, 0), 2);
}

TEST(WaveSlopes, AreTheSlopesOfAPlaneAndLessAtTheShore) {
  const pose::SurfaceSkeleton surface = pond(8.0F, 6.0F, 0.5F);
  const Shore shore(surface);
  WaveSlopes waves(surface, shore);
  std::vector<float> heights_m;
  for (std::size_t i = 0; i < surface.rest_x_m.size(); ++i) {
    heights_m.push_back(0.1F * (surface.rest_x_m[i] - 10.0F) - 0.05F * (surface.rest_z_m[i] + 4.0F));
  }
  waves.move_to(heights_m.data());
  const std::size_t middle = 15 * 41 + 20;
  EXPECT_NEAR(waves.heights_m()[middle], -Shore::kSunk_m, 1e-5F);
  EXPECT_NEAR(waves.slopes()[4 * middle], 0.1F, 1e-4F);
  EXPECT_NEAR(waves.slopes()[4 * middle + 1], -0.05F, 1e-4F);
  EXPECT_NEAR(waves.slopes()[4 * middle + 2], 0.0125F, 1e-4F);
  // In the corner is land: what is left there of a height of 0.55 m.
  EXPECT_NEAR(waves.heights_m()[40] + Shore::kSunk_m, 0.15F * heights_m[40], 1e-4F);
}

TEST(GrowthMapTest, FollowsTheShore) {
  const pose::SurfaceSkeleton surface = pond(8.0F, 8.0F);
  const Shore shore(surface);
  const std::vector<Standing> things{
      {.kind = Standing::Kind::kWater, .bounds = {{6.0F, 0.0F, -8.0F}, {14.0F, 0.1F, 0.0F}}, .shore = &shore}};
  GrowthMap map;
  map.make(things);
  EXPECT_EQ(map.water_at(10.0F, -4.0F), 1.0F);
  // Grass grows in the corners of the rectangle.
  for (const glm::vec2 corner_m : {glm::vec2(6.2F, -7.8F), glm::vec2(13.8F, -0.2F)}) {
    EXPECT_EQ(map.water_at(corner_m.x, corner_m.y), 0.0F);
    EXPECT_GT(map.growth_at(corner_m.x, corner_m.y), 0.2F);
  }
}

}  // namespace
}  // namespace yuragi::viewer::meshes
