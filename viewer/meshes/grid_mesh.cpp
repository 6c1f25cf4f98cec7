#include "viewer/meshes/grid_mesh.hpp"

#include <algorithm>
#include <cmath>

namespace yuragi::viewer::meshes {
namespace {

constexpr float kMinArea_m2 = 1e-16F;

struct Axes {
  const float* x;
  const float* y;
  const float* z;
};

/// The normal of a point: the cross product of `left` to `right` and `above` to `below`.
void write_normal(const Axes& p, std::size_t left, std::size_t right, std::size_t above, std::size_t below, float& nx,
                  float& ny, float& nz) {
  const float ax = p.x[right] - p.x[left];
  const float ay = p.y[right] - p.y[left];
  const float az = p.z[right] - p.z[left];
  const float bx = p.x[below] - p.x[above];
  const float by = p.y[below] - p.y[above];
  const float bz = p.z[below] - p.z[above];
  const float x = ay * bz - az * by;
  const float y = az * bx - ax * bz;
  const float z = ax * by - ay * bx;
  const float scale = 1.0F / std::sqrt(x * x + y * y + z * z + kMinArea_m2 * kMinArea_m2);
  nx = x * scale;
  ny = y * scale;
  nz = z * scale;
}

}  // namespace

GridLayout layout_of(const pose::GridSkeleton& cloth) {
  return {cloth.columns, cloth.rows, cloth.stride(), false};
}
GridLayout layout_of(const pose::SurfaceSkeleton& surface) {
  return {surface.columns, surface.rows, surface.columns, surface.is_closed, surface.is_closed ? surface.shells : 1};
}

std::vector<std::uint32_t> grid_triangles(const GridLayout& layout, std::size_t step) {
  std::vector<std::uint32_t> indices;
  const std::size_t columns = layout.columns / layout.shells;
  if (columns < 2 || layout.rows < 2) return indices;
  const std::size_t cells = layout.is_closed ? columns : columns - 1;
  indices.reserve(6 * layout.shells * (cells / step + 1) * ((layout.rows - 1) / step + 1));
  for (std::size_t shell = 0; shell < layout.shells; ++shell) {
    for (std::size_t row = 0; row + 1 < layout.rows; row += step) {
      const std::size_t first = row * layout.stride + shell * columns;
      const std::size_t down = (std::min(row + step, layout.rows - 1) - row) * layout.stride;
      for (std::size_t column = 0; column < cells; column += step) {
        const std::size_t next = layout.is_closed ? (column + 1) % columns : std::min(column + step, columns - 1);
        const auto here = static_cast<std::uint32_t>(first + column);
        const auto beside = static_cast<std::uint32_t>(first + next);
        const auto below = static_cast<std::uint32_t>(first + down + column);
        const auto across = static_cast<std::uint32_t>(first + down + next);
        indices.insert(indices.end(), {here, beside, below, below, beside, across});
      }
    }
  }
  return indices;
}

void grid_normals(const GridLayout& layout, std::span<const float> points, std::span<float> normals) {
  const std::size_t size = layout.size();
  if (layout.columns == 0 || points.size() < 3 * size || normals.size() < 3 * size) return;
  const Axes p{points.data(), points.data() + size, points.data() + 2 * size};
  float* const nx = normals.data();
  float* const ny = nx + size;
  float* const nz = ny + size;
  const std::size_t columns = layout.columns / layout.shells;
  if (columns == 0) return;
  const std::size_t last = columns - 1;
  for (std::size_t ring = 0; ring < layout.rows * layout.shells; ++ring) {
    const std::size_t row = ring / layout.shells;
    const std::size_t first = row * layout.stride + ring % layout.shells * columns;
    const std::size_t up = row > 0 ? layout.stride : 0;
    const std::size_t down = row + 1 < layout.rows ? layout.stride : 0;
    const auto write = [&](std::size_t i, std::size_t left, std::size_t right) {
      write_normal(p, left, right, i - up, i + down, nx[i], ny[i], nz[i]);
    };
    write(first, layout.is_closed ? first + last : first, last > 0 ? first + 1 : first);
    for (std::size_t i = first + 1; i < first + last; ++i) write(i, i - 1, i + 1);
    if (last > 0) write(first + last, first + last - 1, layout.is_closed ? first : first + last);
  }
}

}  // namespace yuragi::viewer::meshes
