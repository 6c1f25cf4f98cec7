#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "engine/pose/skeleton.hpp"

namespace yuragi::viewer::meshes {

/// The layout of the points of a cloth or a surface in their arrays: point (column, row) at row * stride + column.
struct GridLayout {
  std::size_t columns = 0;
  std::size_t rows = 0;
  std::size_t stride = 0;
  bool is_closed = false;  ///< the last column of a shell is followed by its first
  std::size_t shells = 1;  ///< the columns are this many rings, one within another

  std::size_t size() const { return rows * stride; }
};
GridLayout layout_of(const pose::GridSkeleton& cloth);
GridLayout layout_of(const pose::SurfaceSkeleton& surface);

/// Two triangles for each cell, three indices of points each, all with the same winding; shell after shell. With a
/// `step` above 1, for an open grid: only each step-th column and row, and the last ones, are used.
std::vector<std::uint32_t> grid_triangles(const GridLayout& layout, std::size_t step = 1);

/// A unit normal for each point: the cross product of the differences between its neighbours along the row and along
/// the column (at an edge, between a neighbour and the point itself). Zero where these are parallel.
///
/// `points` and `normals` hold all x, then all y, then all z, layout.size() each. The padding behind `columns` in a row
/// is not written. Pure; allocates nothing.
void grid_normals(const GridLayout& layout, std::span<const float> points, std::span<float> normals);

}  // namespace yuragi::viewer::meshes
