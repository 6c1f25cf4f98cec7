#include "engine/pose/reach.hpp"

#include <array>

#include <gtest/gtest.h>

namespace yuragi::pose {
namespace {

/// Strands with their roots at these places; the padding behind them stands far away and must not count.
StrandSkeleton strands_at(const std::vector<std::pair<float, float>>& places_m) {
  StrandSkeleton strands;
  strands.strand_count = places_m.size();
  strands.root_x_m.assign(strands.padded_count(), 900.0F);
  strands.root_z_m = strands.root_x_m;
  for (std::size_t i = 0; i < places_m.size(); ++i) {
    strands.root_x_m[i] = places_m[i].first;
    strands.root_z_m[i] = places_m[i].second;
  }
  return strands;
}

double reach_of_one(const Skeleton& skeleton) {
  return scenes_reach_m(std::array{&skeleton});
}

TEST(ScenesReach, IsNothingWithoutScenesOrElements) {
  EXPECT_EQ(scenes_reach_m({}), 0.0);
  EXPECT_EQ(reach_of_one(StrandSkeleton{}), 0.0);
  EXPECT_EQ(reach_of_one(GridSkeleton{}), 0.0);
  EXPECT_EQ(reach_of_one(TreeSkeleton{}), 0.0);
  EXPECT_EQ(reach_of_one(SurfaceSkeleton{}), 0.0);
}

TEST(ScenesReach, GoesToTheFarthestRootOfAStrandInAnyDirection) {
  EXPECT_EQ(reach_of_one(strands_at({{1.0F, 1.0F}, {-3.0F, -4.0F}, {0.0F, 2.0F}})), 5.0);
}

TEST(ScenesReach, GoesToTheFarthestJointOfAClothWithoutItsPadding) {
  GridSkeleton grid;
  grid.columns = 3;
  grid.rows = 2;
  grid.rest_x_m.assign(grid.rows * grid.stride(), 900.0F);
  grid.rest_y_m.assign(grid.rows * grid.stride(), 700.0F);  // upward does not count
  grid.rest_z_m.assign(grid.rows * grid.stride(), -2.0F);
  for (std::size_t row = 0; row < grid.rows; ++row) {
    for (std::size_t column = 0; column < grid.columns; ++column) {
      grid.rest_x_m[row * grid.stride() + column] = 0.1F * static_cast<float>(column);
    }
  }
  grid.rest_x_m[grid.stride() + 2] = 1.5F;  // in the last row and column
  EXPECT_EQ(reach_of_one(grid), 2.5);
}

TEST(ScenesReach, GoesToTheFarthestRootOfAnyLevelOfATree) {
  TreeSkeleton tree;
  tree.levels.resize(3);
  tree.levels[0].strands = strands_at({{3.0F, 0.0F}});
  tree.levels[1].strands = strands_at({{3.5F, 0.0F}, {6.0F, 8.0F}});
  tree.levels[2].strands = strands_at({{4.0F, 1.0F}});
  EXPECT_EQ(reach_of_one(tree), 10.0);
}

TEST(ScenesReach, GoesToTheFarthestPointOfAllScenes) {
  SurfaceSkeleton surface;
  surface.columns = 2;
  surface.rows = 1;
  surface.rest_x_m = {0.0F, -30.0F};
  surface.rest_y_m = {0.0F, 0.0F};
  surface.rest_z_m = {1.0F, 40.0F};
  const Skeleton pond = surface;
  const Skeleton meadow = strands_at({{2.0F, 2.0F}});
  EXPECT_EQ(scenes_reach_m(std::array{&meadow, &pond}), 50.0);
  EXPECT_EQ(scenes_reach_m(std::array{&pond, &meadow}), 50.0);
}

}  // namespace
}  // namespace yuragi::pose
