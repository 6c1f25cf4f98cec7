#include "viewer/meshes/grid_mesh.hpp"

#include <cmath>
#include <set>

#include <gtest/gtest.h>

#include "engine/base/units.hpp"

namespace yuragi::viewer::meshes {
namespace {

TEST(GridTriangles, CoverEachCellTwiceAndLeaveOutThePadding) {
  const GridLayout layout{5, 4, 16, false};
  const std::vector<std::uint32_t> indices = grid_triangles(layout);
  EXPECT_EQ(indices.size(), 3U * 2U * 4U * 3U);
  std::set<std::uint32_t> used(indices.begin(), indices.end());
  EXPECT_EQ(used.size(), 5U * 4U);
  for (const std::uint32_t index : used) EXPECT_LT(index % 16, 5U);
}

TEST(GridTriangles, CloseABody) {
  const std::vector<std::uint32_t> indices = grid_triangles({8, 2, 8, true});
  EXPECT_EQ(indices.size(), 3U * 2U * 8U);
  // The last column's cell ends at the first.
  EXPECT_EQ(indices[indices.size() - 6], 7U);
  EXPECT_EQ(indices[indices.size() - 5], 0U);
}

TEST(GridTriangles, CloseEachShellAndLeaveTheSpaceBetweenShellsEmpty) {
  const GridLayout layout{12, 3, 12, true, 3};
  const std::vector<std::uint32_t> indices = grid_triangles(layout);
  ASSERT_EQ(indices.size(), 3U * 3U * 2U * 4U * 2U);
  for (std::size_t i = 0; i < indices.size(); ++i) {
    const std::size_t shell = i / (indices.size() / 3);  // one after the other
    EXPECT_EQ(indices[i] % 12 / 4, shell);
  }
}

TEST(GridNormals, OfEachShellPointAwayFromTheAxisAllAround) {
  // Two tubes, one within another: the normal of a point is along its radius, across the seam too.
  const GridLayout layout{24, 4, 24, true, 2};
  std::vector<float> points(3 * layout.size());
  for (std::size_t i = 0; i < layout.size(); ++i) {
    const std::size_t column = i % 24;
    const double angle = 2.0 * kPi * static_cast<double>(column % 12) / 12.0;
    const double radius = column < 12 ? 1.0 : 0.4;
    points[i] = static_cast<float>(radius * std::cos(angle));
    points[layout.size() + i] = static_cast<float>(i / 24);
    points[2 * layout.size() + i] = static_cast<float>(radius * std::sin(angle));
  }
  std::vector<float> normals(points.size());
  grid_normals(layout, points, normals);
  for (std::size_t i = 0; i < layout.size(); ++i) {
    const float radius = std::hypot(points[i], points[2 * layout.size() + i]);
    const float along =
        (normals[i] * points[i] + normals[2 * layout.size() + i] * points[2 * layout.size() + i]) / radius;
    EXPECT_NEAR(std::abs(along), 1.0F, 1e-5F) << i;
  }
}

TEST(GridTriangles, OfASteppedGridReachItsLastColumnAndRow) {
  const std::vector<std::uint32_t> triangles = grid_triangles({.columns = 6, .rows = 4, .stride = 6}, 4);
  // Columns 0, 4 and 5, rows 0 and 3.
  EXPECT_EQ(triangles.size(), 2U * 6U);
  EXPECT_EQ(std::set<std::uint32_t>(triangles.begin(), triangles.end()),
            (std::set<std::uint32_t>{0, 4, 5, 18, 22, 23}));
}

TEST(GridTriangles, AreNoneWhereThereIsNoCell) {
  EXPECT_TRUE(grid_triangles({1, 5, 16, false}).empty());
  EXPECT_TRUE(grid_triangles({5, 1, 16, false}).empty());
  EXPECT_TRUE(grid_triangles({}).empty());
}

TEST(GridNormals, AreAcrossAPlane) {
  // A slope that rises to the east: the normal leans to the west.
  const GridLayout layout{6, 5, 16, false};
  std::vector<float> points(3 * layout.size());
  for (std::size_t row = 0; row < 5; ++row) {
    for (std::size_t column = 0; column < 6; ++column) {
      const std::size_t i = row * 16 + column;
      points[i] = static_cast<float>(column);
      points[layout.size() + i] = static_cast<float>(column);
      points[2 * layout.size() + i] = static_cast<float>(row);
    }
  }
  std::vector<float> normals(points.size());
  grid_normals(layout, points, normals);
  const auto half = static_cast<float>(std::sqrt(0.5));
  for (std::size_t row = 0; row < 5; ++row) {
    for (std::size_t column = 0; column < 6; ++column) {
      const std::size_t i = row * 16 + column;
      const float up = normals[layout.size() + i];
      EXPECT_NEAR(std::abs(up), half, 1e-6F);
      EXPECT_NEAR(normals[i], -up, 1e-6F);
      EXPECT_NEAR(normals[2 * layout.size() + i], 0.0F, 1e-6F);
    }
  }
}

TEST(GridNormals, PointOutOfARoundBodyWithoutASeam) {
  constexpr std::size_t kColumns = 24;
  const GridLayout layout{kColumns, 3, kColumns, true};
  std::vector<float> points(3 * layout.size());
  for (std::size_t i = 0; i < layout.size(); ++i) {
    const double angle = 2 * kPi * static_cast<double>(i % kColumns) / kColumns;
    points[i] = static_cast<float>(std::cos(angle));
    const std::size_t row = i / kColumns;
    points[layout.size() + i] = static_cast<float>(row);
    points[2 * layout.size() + i] = static_cast<float>(std::sin(angle));
  }
  std::vector<float> normals(points.size());
  grid_normals(layout, points, normals);
  for (std::size_t i = 0; i < layout.size(); ++i) {
    const float outward = normals[i] * points[i] + normals[2 * layout.size() + i] * points[2 * layout.size() + i];
    EXPECT_NEAR(std::abs(outward), 1.0F, 1e-5F);
  }
}

TEST(GridNormals, StayFiniteWherePointsFallTogether) {
  const GridLayout layout{4, 4, 16, false};
  const std::vector<float> points(3 * layout.size(), 1.0F);
  std::vector<float> normals(points.size(), 7.0F);
  grid_normals(layout, points, normals);
  for (const std::size_t i : {0U, 17U, 51U}) EXPECT_EQ(normals[i], 0.0F);
  EXPECT_EQ(normals[4], 7.0F);  // the padding is left alone
}

}  // namespace
}  // namespace yuragi::viewer::meshes
