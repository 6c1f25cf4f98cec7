#include "viewer/meshes/flame_volume.hpp"

#include <algorithm>
#include <numeric>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "engine/pose/pose_arrays.hpp"
#include "tests/viewer/test_models.hpp"

namespace yuragi::viewer::meshes {
namespace {

const pose::SurfaceSkeleton& flame() {
  static const wire::SceneModel model = test_model("flame", {3.0, -2.0});
  return std::get<pose::SurfaceSkeleton>(model.skeleton);
}
pose::SurfacePose at_rest() {
  return std::get<pose::SurfacePose>(pose::rest_pose(flame()));
}

/// The heat at a texel of the layer that is so much of the way up.
int heat_at(const FlameVolume& volume, double up, std::size_t x, std::size_t z) {
  constexpr std::size_t n = FlameVolume::kAcross;
  const auto layer = static_cast<std::size_t>(up * static_cast<double>(volume.layers() - 1));
  return volume.heat()[(layer * n + z) * n + x];
}

TEST(FlameVolume, IsAsHotAsItsPointsAndColdInTheCorners) {
  FlameVolume volume(flame());
  ASSERT_FALSE(volume.is_empty());
  pose::SurfacePose pose = at_rest();
  std::fill(pose.heat.begin(), pose.heat.end(), 0.8F);
  volume.move_to(flame(), pose);
  constexpr std::size_t n = FlameVolume::kAcross;
  EXPECT_NEAR(heat_at(volume, 0.5, n / 2, n / 2), 204, 1);
  EXPECT_EQ(heat_at(volume, 0.5, 0, 0), 0);
  EXPECT_EQ(heat_at(volume, 0.5, n - 1, n / 2 - 1), 0) << "nothing is cut off at the end of a layer";
  EXPECT_NEAR(volume.mean_heat(), 0.8F, 1e-5F);
  EXPECT_NEAR(volume.hot_middle_m().x, 3.0F, 1e-4F);
  EXPECT_NEAR(volume.hot_middle_m().z, -2.0F, 1e-4F);
}

TEST(FlameVolume, HasEachColumnsHeatOnItsSide) {
  FlameVolume volume(flame());
  pose::SurfacePose pose = at_rest();
  for (std::size_t i = 0; i < pose.heat.size(); ++i) pose.heat[i] = flame().rest_x_m[i] > 3.0F ? 1.0F : 0.0F;
  volume.move_to(flame(), pose);
  constexpr std::size_t n = FlameVolume::kAcross;
  EXPECT_GT(heat_at(volume, 0.5, 2 * n / 3, n / 2), 200);
  EXPECT_LT(heat_at(volume, 0.5, n / 3 - 1, n / 2), 50);
  EXPECT_GT(volume.hot_middle_m().x, 2.9F);
}

TEST(FlameVolume, IsHotterInsideWhereTheInnerShellIs) {
  FlameVolume volume(flame());
  pose::SurfacePose pose = at_rest();
  const std::size_t around = flame().columns / flame().shells;
  for (std::size_t i = 0; i < pose.heat.size(); ++i) pose.heat[i] = i % flame().columns >= around ? 1.0F : 0.2F;
  volume.move_to(flame(), pose);
  constexpr std::size_t n = FlameVolume::kAcross;
  EXPECT_EQ(heat_at(volume, 0.5, n / 2, n / 2), 255);
  EXPECT_LT(heat_at(volume, 0.5, 5 * n / 6, n / 2), 120);
}

TEST(FlameVolume, BendsWithItsRows) {
  FlameVolume volume(flame());
  pose::SurfacePose pose = at_rest();
  for (std::size_t row = 0; row < flame().rows; ++row) {
    const float up = static_cast<float>(row) / static_cast<float>(flame().rows - 1);
    pose.row_east_m[row] = 0.6F * up;
    pose.row_drop_m[row] = 0.2F * up;
    pose.row_slope_east[row] = 0.5F;
  }
  volume.move_to(flame(), pose);
  const glm::vec3 top = volume.place_m(0.0F, 0.0F, 1.0F);
  EXPECT_NEAR(top.x, 3.6F, 1e-4F);
  EXPECT_NEAR(top.y, 0.5F + 1.2F - 0.2F, 1e-4F);
  EXPECT_NEAR(volume.place_m(0.1F, 0.0F, 0.5F).y, volume.place_m(0.0F, 0.0F, 0.5F).y - 0.05F, 1e-5F);
  EXPECT_NEAR(volume.layer_rows()[20].to_top_m.x, 0.6F, 1e-3F);
  EXPECT_NEAR(volume.layer_rows()[20].slope_east_grows, 0.0F, 1e-4F);
}

TEST(FlameVolume, ItsSkinIsClosedAndAroundAllOfIt) {
  FlameVolume volume(flame());
  volume.move_to(flame(), at_rest());
  // Each edge is shared by two triangles that go along it in opposite directions.
  const auto indices = volume.hull_indices();
  std::vector<std::pair<int, int>> edges;
  for (std::size_t i = 0; i < indices.size(); i += 3) {
    for (std::size_t corner = 0; corner < 3; ++corner)
      edges.emplace_back(indices[i + corner], indices[i + (corner + 1) % 3]);
  }
  std::sort(edges.begin(), edges.end());
  for (const auto& [from, to] : edges) {
    EXPECT_TRUE(std::binary_search(edges.begin(), edges.end(), std::pair(to, from)));
  }
  // Fronts face outward.
  for (std::size_t i = 0; i < indices.size(); i += 3) {
    const auto place = [&](std::size_t corner) { return volume.hull()[indices[i + corner]].place_m; };
    const glm::vec3 out = glm::cross(place(1) - place(0), place(2) - place(0));
    EXPECT_GE(glm::dot(out, (place(0) + place(1) + place(2)) / 3.0F - glm::vec3(3.0F, 1.1F, -2.0F)), 0.0F) << i;
  }
}

TEST(FlameVolume, IsEmptyOfASheetAndOfNothing) {
  EXPECT_TRUE(FlameVolume(std::get<pose::SurfaceSkeleton>(test_model("flame panel").skeleton)).is_empty());
  EXPECT_TRUE(FlameVolume({}).is_empty());
}

}  // namespace
}  // namespace yuragi::viewer::meshes
