#include "viewer/meshes/cloth_surface.hpp"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

namespace yuragi::viewer::meshes {
namespace {

/// The number of points along a side with this many joints.
std::size_t refined(std::size_t joints, int level) {
  if (joints < 2) return joints;
  const std::size_t cells = joints - 1;
  return 1 + (level >= 0 ? cells << level : std::max<std::size_t>(cells >> -level, std::min<std::size_t>(cells, 4)));
}

GridLayout refined(const GridLayout& joints, int level, int finer_down) {
  GridLayout points;
  do {
    points.columns = refined(joints.columns, level);
    points.rows =
        refined(joints.rows, std::clamp(level + finer_down, 2 * ClothSurface::kCoarsest, ClothSurface::kFinest));
  } while (points.columns * points.rows > ClothSurface::kMaxPoints && --level >= ClothSurface::kCoarsest);
  points.stride = points.columns;
  return points;
}

std::size_t steps_within(float reach_m, const glm::vec2& step_m, std::size_t points) {
  const float length_m = glm::length(step_m);
  const float steps = length_m > 0.0F ? std::round(reach_m / length_m) : 1.0F;
  return static_cast<std::size_t>(std::clamp(steps, 1.0F, static_cast<float>(std::max<std::size_t>(points / 4, 1))));
}

}  // namespace

std::vector<ClothSurface::Taps> ClothSurface::taps(std::size_t joints, std::size_t points) {
  std::vector<Taps> all(points);
  for (std::size_t i = 0; i < points; ++i) {
    Taps& tap = all[i];
    if (joints < 2) {
      tap = {{0, 0, 0, 0}, {0.0F, 1.0F, 0.0F, 0.0F}};
      continue;
    }
    const double along = static_cast<double>(i * (joints - 1)) / static_cast<double>(points - 1);
    const std::size_t first = std::min(static_cast<std::size_t>(along), joints - 2);
    const auto t = static_cast<float>(along - static_cast<double>(first));
    const float t2 = t * t;
    const float t3 = t2 * t;
    float before = 0.5F * (2.0F * t2 - t - t3);
    float here = 0.5F * (3.0F * t3 - 5.0F * t2 + 2.0F);
    float next = 0.5F * (t + 4.0F * t2 - 3.0F * t3);
    float after = 0.5F * (t3 - t2);
    // Beyond the ends the cloth is extended straight.
    if (first == 0) {
      here += 2.0F * before;
      next -= before;
      before = 0.0F;
    }
    if (first + 2 == joints) {
      next += 2.0F * after;
      here -= after;
      after = 0.0F;
    }
    tap = {{first == 0 ? 0 : first - 1, first, first + 1, std::min(first + 2, joints - 1)},
           {before, here, next, after}};
  }
  return all;
}

ClothSurface::ClothSurface(const GridLayout& joints, int level, int finer_down)
    : joints_(joints),
      layout_(refined(joints, std::clamp(level, kCoarsest, kFinest), finer_down)),
      across_(taps(joints.columns, layout_.columns)),
      down_(taps(joints.rows, layout_.rows)),
      row_(3 * joints.columns),
      points_(3 * layout_.size()),
      normals_(3 * layout_.size()) {
  if (layout_.columns < 2 || layout_.rows < 2) return;
  const std::size_t last_row = (layout_.rows - 1) * layout_.columns;
  for (std::size_t i = 0; i + 1 < layout_.columns; ++i) rim_.push_back(i);
  for (std::size_t i = 0; i + 1 < layout_.rows; ++i) rim_.push_back((i + 1) * layout_.columns - 1);
  for (std::size_t i = layout_.columns; i-- > 1;) rim_.push_back(last_row + i);
  for (std::size_t i = layout_.rows; i-- > 0;) rim_.push_back(i * layout_.columns);
}

void ClothSurface::move_to(std::span<const float> joints) {
  const std::size_t size = joints_.size();
  if (joints.size() < 3 * size || layout_.size() == 0) return;
  const std::size_t columns = joints_.columns;
  for (std::size_t row = 0; row < layout_.rows; ++row) {
    const Taps& down = down_[row];
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const float* const from = joints.data() + axis * size;
      const float* const a = from + down.at[0] * joints_.stride;
      const float* const b = from + down.at[1] * joints_.stride;
      const float* const c = from + down.at[2] * joints_.stride;
      const float* const d = from + down.at[3] * joints_.stride;
      float* const mixed = row_.data() + axis * columns;
      for (std::size_t i = 0; i < columns; ++i) {
        mixed[i] = down.weight[0] * a[i] + down.weight[1] * b[i] + down.weight[2] * c[i] + down.weight[3] * d[i];
      }
      float* const to = points_.data() + axis * layout_.size() + row * layout_.columns;
      for (std::size_t i = 0; i < layout_.columns; ++i) {
        const Taps& tap = across_[i];
        to[i] = tap.weight[0] * mixed[tap.at[0]] + tap.weight[1] * mixed[tap.at[1]] + tap.weight[2] * mixed[tap.at[2]] +
                tap.weight[3] * mixed[tap.at[3]];
      }
    }
  }
  grid_normals(layout_, points_, normals_);
}

void ClothSurface::write_bends(float reach_m, const ClothMeasure& lies, std::span<float> bends_per_m) const {
  const std::size_t size = layout_.size();
  if (bends_per_m.size() < size || layout_.columns < 2 || layout_.rows < 2) return;
  const auto finer = [](std::size_t joints, std::size_t points) {
    return static_cast<float>(joints - 1) / static_cast<float>(points - 1);
  };
  const std::size_t aside =
      steps_within(reach_m, lies.per_column_m * finer(joints_.columns, layout_.columns), layout_.columns);
  const std::size_t below =
      steps_within(reach_m, lies.per_row_m * finer(joints_.rows, layout_.rows), layout_.rows) * layout_.columns;
  const float* const x = points_.data();
  const float* const y = x + size;
  const float* const z = y + size;
  const float* const nx = normals_.data();
  const float* const ny = nx + size;
  const float* const nz = ny + size;
  // Along the normal: the offset from the midpoint of the two neighbours, over the square of half their distance.
  const auto bend = [&](std::size_t i, std::size_t a, std::size_t b) {
    const glm::vec3 chord(x[b] - x[a], y[b] - y[a], z[b] - z[a]);
    const float sag =
        nx[i] * (x[a] + x[b] - 2.0F * x[i]) + ny[i] * (y[a] + y[b] - 2.0F * y[i]) + nz[i] * (z[a] + z[b] - 2.0F * z[i]);
    return 4.0F * sag / (glm::dot(chord, chord) + 1e-6F);
  };
  for (std::size_t row = 0; row < layout_.rows; ++row) {
    for (std::size_t column = 0; column < layout_.columns; ++column) {
      const std::size_t i = row * layout_.columns + column;
      const bool has_sides = column >= aside && column + aside < layout_.columns;
      const bool has_ends = i >= below && i + below < size;
      bends_per_m[i] =
          (has_sides ? bend(i, i - aside, i + aside) : 0.0F) + (has_ends ? bend(i, i - below, i + below) : 0.0F);
    }
  }
}

std::vector<float> ClothSurface::places_m(const ClothMeasure& lies) const {
  const std::size_t size = layout_.size();
  std::vector<float> places_m(2 * size);
  for (std::size_t row = 0; row < layout_.rows; ++row) {
    for (std::size_t column = 0; column < layout_.columns; ++column) {
      const float across = static_cast<float>(column * (joints_.columns - 1)) /
                           static_cast<float>(std::max<std::size_t>(layout_.columns - 1, 1));
      const float down =
          static_cast<float>(row * (joints_.rows - 1)) / static_cast<float>(std::max<std::size_t>(layout_.rows - 1, 1));
      const glm::vec2 place_m = lies.origin_m + across * lies.per_column_m + down * lies.per_row_m;
      places_m[row * layout_.columns + column] = place_m.x;
      places_m[size + row * layout_.columns + column] = place_m.y;
    }
  }
  return places_m;
}

void ClothSurface::write_rim(float half_thickness_m, std::span<float> points, std::span<float> normals) const {
  const std::size_t size = layout_.size();
  const std::size_t count = 2 * rim_.size();
  if (points.size() < 3 * count || normals.size() < 3 * count) return;
  const auto at = [&](const std::vector<float>& of, std::size_t i) {
    return glm::vec3(of[i], of[size + i], of[2 * size + i]);
  };
  for (std::size_t i = 0; i < rim_.size(); ++i) {
    const glm::vec3 place = at(points_, rim_[i]);
    const glm::vec3 before = at(points_, rim_[i == 0 ? rim_.size() - 2 : i - 1]);
    const glm::vec3 next = at(points_, rim_[i + 1 == rim_.size() ? 1 : i + 1]);
    const glm::vec3 normal = at(normals_, rim_[i]);
    // Following the edges in the order of rim(), the cloth is on the right of its normal.
    const glm::vec3 across = glm::cross(next - before, normal);
    const glm::vec3 out = across / (glm::length(across) + 1e-9F);
    for (const std::size_t side : {std::size_t{0}, std::size_t{1}}) {
      const float sign = side == 0 ? 1.0F : -1.0F;
      const glm::vec3 there = place + sign * half_thickness_m * normal;
      const glm::vec3 facing = 0.7071F * (out + sign * normal);
      for (glm::length_t axis = 0; axis < 3; ++axis) {
        const std::size_t to = static_cast<std::size_t>(axis) * count + 2 * i + side;
        points[to] = there[axis];
        normals[to] = facing[axis];
      }
    }
  }
}

}  // namespace yuragi::viewer::meshes
