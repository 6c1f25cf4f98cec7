#include "viewer/meshes/flame_volume.hpp"

#include <algorithm>
#include <cmath>

#include <glm/vec2.hpp>

#include "engine/base/units.hpp"
#include "engine/pose/pose_arrays.hpp"

namespace yuragi::viewer::meshes {
namespace {

/// The half side of a layer, in radii of its outermost shell: room for the streamed displacements.
constexpr float kRoom = 1.45F;
/// Outside of its outermost shell the heat falls to zero over this part of the radius.
constexpr float kSoftEdge = 0.40F;
/// Minimum thickness of a layer, as a part of the thickest: at the end of the body the tongues end by themselves.
constexpr float kThinnest = 0.66F;
constexpr float kMinRadius_m = 1e-3F;
constexpr float kTurn_rad = static_cast<float>(2.0 * kPi);

}  // namespace

FlameVolume::FlameVolume(const pose::SurfaceSkeleton& surface) {
  if (!surface.is_closed || surface.rows < 2 || surface.shells == 0 || surface.columns / surface.shells < 3) return;
  shells_ = surface.shells;
  around_ = surface.columns / shells_;
  rows_count_ = surface.rows;
  layers_ = std::min(rows_count_, kMaxLayers);
  rows_.resize(static_cast<std::size_t>(std::lrint(kReach * static_cast<float>(layers_ - 1))) + 1);
  middles_m_.resize(rows_.size());
  heat_.assign(kAcross * kAcross * layers_, 0);
  radius_.resize(surface.columns * layers_);
  hot_.resize(surface.columns * layers_);

  // The thickness of each layer; a row's middle is that of its outermost ring.
  std::vector<float> radii_m(layers_);
  std::size_t thickest = 0;
  for (std::size_t layer = 0; layer < layers_; ++layer) {
    const std::size_t first = row_of(layer) * surface.columns;
    glm::vec3 sum_m(0.0F);
    for (std::size_t i = first; i < first + around_; ++i) {
      sum_m += glm::vec3(surface.rest_x_m[i], surface.rest_y_m[i], surface.rest_z_m[i]);
    }
    middles_m_[layer] = sum_m / static_cast<float>(around_);
    for (std::size_t i = first; i < first + around_; ++i) {
      radii_m[layer] = std::max(radii_m[layer], std::hypot(surface.rest_x_m[i] - middles_m_[layer].x,
                                                           surface.rest_z_m[i] - middles_m_[layer].z));
    }
    if (radii_m[layer] > radii_m[thickest]) thickest = layer;
  }
  thickest_m_ = radii_m[thickest];
  height_m_ = middles_m_[layers_ - 1].y - middles_m_.front().y;
  for (std::size_t layer = 0; layer < layers_; ++layer) {
    const float v = static_cast<float>(layer) / static_cast<float>(layers_ - 1);
    const float least_m = kThinnest * thickest_m_ * std::min(1.0F, 0.3F + 4.0F * v);
    rows_[layer].half_m = kRoom * std::max({radii_m[layer], least_m, kMinRadius_m});
  }

  for (std::size_t layer = layers_; layer < rows_.size(); ++layer) rows_[layer].half_m = rows_[layers_ - 1].half_m;

  // The positions of the columns around the middle, and of the shells within one another.
  const std::size_t row = row_of(thickest) * surface.columns;
  const auto out_m = [&](std::size_t column) {
    return glm::vec2(surface.rest_x_m[row + column] - middles_m_[thickest].x,
                     surface.rest_z_m[row + column] - middles_m_[thickest].z);
  };
  const glm::vec2 first_m = out_m(0);
  const glm::vec2 second_m = out_m(1);
  const float begins_rad = std::atan2(first_m.y, first_m.x);
  const float way = first_m.x * second_m.y - first_m.y * second_m.x < 0.0F ? -1.0F : 1.0F;
  for (std::size_t shell = 0; shell < shells_; ++shell) {
    const glm::vec2 at_m = out_m(shell * around_);
    shell_parts_.push_back(std::hypot(at_m.x, at_m.y) / std::max(thickest_m_, kMinRadius_m));
  }
  for (std::size_t z = 0; z < kAcross; ++z) {
    for (std::size_t x = 0; x < kAcross; ++x) {
      const auto to_side = [](std::size_t i) {
        return (2.0F * static_cast<float>(i) + 1.0F) / static_cast<float>(kAcross) - 1.0F;
      };
      float turn = way * (std::atan2(to_side(z), to_side(x)) - begins_rad) / kTurn_rad;
      turn = (turn - std::floor(turn)) * static_cast<float>(around_);
      const float column = std::min(std::floor(turn), static_cast<float>(around_ - 1));
      texels_.push_back({static_cast<std::uint32_t>(column), turn - column, std::hypot(to_side(x), to_side(z))});
    }
  }

  hull_.resize(kHullRings * kHullSides + 2);
  const auto corner = [](std::size_t ring, std::size_t side) {
    return static_cast<std::uint16_t>(ring * kHullSides + side % kHullSides);
  };
  const auto foot = static_cast<std::uint16_t>(kHullRings * kHullSides);
  const auto top = static_cast<std::uint16_t>(foot + 1);
  for (std::size_t side = 0; side < kHullSides; ++side) {
    for (std::size_t ring = 0; ring + 1 < kHullRings; ++ring) {
      indices_.insert(indices_.end(), {corner(ring, side), corner(ring + 1, side), corner(ring, side + 1),
                                       corner(ring, side + 1), corner(ring + 1, side), corner(ring + 1, side + 1)});
    }
    indices_.insert(indices_.end(), {foot, corner(0, side), corner(0, side + 1), top, corner(kHullRings - 1, side + 1),
                                     corner(kHullRings - 1, side)});
  }
  move_to(surface, std::get<pose::SurfacePose>(pose::rest_pose(surface)));
}

std::size_t FlameVolume::row_of(std::size_t layer) const {
  return (layer * (rows_count_ - 1) + (layers_ - 1) / 2) / (layers_ - 1);
}

glm::vec3 FlameVolume::place_m(float east_m, float south_m, float v) const {
  const float at = std::clamp(v * static_cast<float>(layers_ - 1), 0.0F, static_cast<float>(rows_.size() - 1));
  const std::size_t layer = std::min(static_cast<std::size_t>(at), rows_.size() - 2);
  const float part = at - static_cast<float>(layer);
  const auto between = [part](const auto& a, const auto& b) { return a + part * (b - a); };
  const Layer& below = rows_[layer];
  const Layer& above = rows_[layer + 1];
  const float down_m =
      between(below.slope_east, above.slope_east) * east_m + between(below.slope_south, above.slope_south) * south_m;
  return between(middles_m_[layer], middles_m_[layer + 1]) + glm::vec3(east_m, -down_m, south_m);
}

void FlameVolume::move_to(const pose::SurfaceSkeleton& surface, const pose::SurfacePose& pose, float share) {
  if (is_empty()) return;
  const bool moves_rows = pose.row_east_m.size() == rows_count_;
  glm::dvec3 hot_m(0.0);
  double heat = 0.0;
  for (std::size_t layer = 0; layer < layers_; ++layer) {
    const std::size_t row = row_of(layer);
    const std::size_t first = row * surface.columns;
    Layer& here = rows_[layer];
    glm::vec3 middle_m(0.0F);
    for (std::size_t i = first; i < first + around_; ++i) {
      middle_m += glm::vec3(surface.rest_x_m[i], surface.rest_y_m[i], surface.rest_z_m[i]);
    }
    middle_m /= static_cast<float>(around_);
    if (moves_rows) {
      middle_m += glm::vec3(pose.row_east_m[row], -pose.row_drop_m[row], pose.row_south_m[row]);
      here.slope_east += share * (pose.row_slope_east[row] - here.slope_east);
      here.slope_south += share * (pose.row_slope_south[row] - here.slope_south);
    }
    middles_m_[layer] += share * (middle_m - middles_m_[layer]);

    // Each point's distance from the middle, in radii of the outermost shell at rest.
    double sum = 0.0;
    float* const hot_here = hot_.data() + layer * surface.columns;
    float* const radius_here = radius_.data() + layer * surface.columns;
    for (std::size_t shell = 0; shell < shells_; ++shell) {
      for (std::size_t column = 0; column < around_; ++column) {
        const std::size_t i = first + shell * around_ + column;
        const float east = surface.normal_x[i];
        const float south = surface.normal_z[i];
        const float radius_m = std::max(shell_parts_[shell] * here.half_m / kRoom, kMinRadius_m);
        const float swell = std::sqrt(east * east + south * south) * pose.displacement_m[i] / radius_m;
        const float swollen = shell_parts_[shell] * (1.0F + std::clamp(swell, -0.8F, kRoom - 1.0F));
        float& radius = radius_here[shell * around_ + column];
        radius += share * (swollen - radius);
        float& hot = hot_here[shell * around_ + column];
        hot += share * ((pose.heat.empty() ? 0.0F : pose.heat[i]) - hot);
        sum += static_cast<double>(hot);
      }
    }
    heat += sum;
    hot_m += sum * glm::dvec3(middles_m_[layer]);

    std::uint8_t* texel = heat_.data() + layer * kAcross * kAcross;
    for (const Texel& at : texels_) {
      if (at.radius >= 1.0F) {
        *texel++ = 0;
        continue;
      }
      const float radius = kRoom * at.radius;
      const std::size_t next = at.column + 1 == around_ ? 0 : at.column + 1;
      const auto of = [&](const float* values, std::size_t shell) {
        const float* const ring = values + shell * around_;
        return ring[at.column] + at.part * (ring[next] - ring[at.column]);
      };
      float outer = of(radius_here, 0);
      float level = of(hot_here, 0);
      if (radius >= outer) {
        level *= std::max(0.0F, 1.0F - (radius - outer) / kSoftEdge);
      } else {
        for (std::size_t shell = 1; shell < shells_; ++shell) {
          const float inner = std::min(of(radius_here, shell), outer - 1e-3F);
          const float inner_level = of(hot_here, shell);
          if (radius >= inner) {
            level += (outer - radius) / (outer - inner) * (inner_level - level);
            break;
          }
          outer = inner;
          level = inner_level;
        }
      }
      // No hard cut at the end of the layer.
      level *= std::min(1.0F, 8.0F * std::max(0.0F, 0.95F - at.radius));
      *texel++ = static_cast<std::uint8_t>(std::lrint(255.0F * std::clamp(level, 0.0F, 1.0F)));
    }
  }
  mean_heat_ = static_cast<float>(heat / static_cast<double>(layers_ * surface.columns));
  hot_middle_m_ = heat > 0.0 ? glm::vec3(hot_m / heat) : (middles_m_.front() + middles_m_[layers_ - 1]) / 2.0F;

  // Above the top the shape of the last quarter continues.
  const std::size_t last = layers_ - 1;
  const std::size_t quarter = std::max<std::size_t>(last / 4, 1);
  const glm::vec3 goes_on_m = (middles_m_[last] - middles_m_[last - quarter]) / static_cast<float>(quarter);
  for (std::size_t layer = layers_; layer < rows_.size(); ++layer) {
    middles_m_[layer] = middles_m_[layer - 1] + goes_on_m;
    rows_[layer].slope_east = rows_[last].slope_east;
    rows_[layer].slope_south = rows_[last].slope_south;
  }

  const auto layers = static_cast<float>(layers_ - 1);
  for (std::size_t layer = 0; layer < rows_.size(); ++layer) {
    const std::size_t below = layer == 0 ? 0 : layer - 1;
    const std::size_t above = std::min(layer + 1, rows_.size() - 1);
    const float per_v = layers / static_cast<float>(above - below);
    rows_[layer].to_top_m = per_v * (middles_m_[above] - middles_m_[below]);
    rows_[layer].slope_east_grows = per_v * (rows_[above].slope_east - rows_[below].slope_east);
    rows_[layer].slope_south_grows = per_v * (rows_[above].slope_south - rows_[below].slope_south);
  }
  wrap_to(kReach, {});
}

void FlameVolume::wrap(std::span<const float> extents) {
  std::size_t top = extents.size();
  while (top > 1 && extents[top - 1] <= 0.0F) --top;
  if (is_empty() || top < 2) return;
  wrap_to(std::min(kReach, kReach * static_cast<float>(top) / static_cast<float>(extents.size() - 1)), extents);
}

void FlameVolume::wrap_to(float top_v, std::span<const float> extents) {
  // Its corners are so far out that its sides do not cut the layers.
  const float out = 1.0F / std::cos(0.5F * kTurn_rad / static_cast<float>(kHullSides));
  const auto put = [&](HullVertex& vertex, float east_m, float south_m, float v) {
    vertex = {place_m(east_m, south_m, v), {east_m, south_m, v}};
  };
  const float ring_v = top_v / static_cast<float>(kHullRings - 1);
  // The widest extent nearer than the next rings.
  const auto extent_at = [&](float v) {
    if (extents.empty()) return 1.0F;
    const float per_v = static_cast<float>(extents.size() - 1) / kReach;
    const auto from = static_cast<std::size_t>(std::max(std::floor((v - ring_v) * per_v), 0.0F));
    const auto to = std::min(static_cast<std::size_t>(std::ceil((v + ring_v) * per_v)), extents.size() - 1);
    return *std::max_element(extents.begin() + static_cast<std::ptrdiff_t>(std::min(from, to)),
                             extents.begin() + static_cast<std::ptrdiff_t>(to) + 1);
  };
  for (std::size_t ring = 0; ring < kHullRings; ++ring) {
    const float v = ring_v * static_cast<float>(ring);
    const auto at = static_cast<std::size_t>(std::lrint(v * static_cast<float>(layers_ - 1)));
    const float half_m = out * extent_at(v) * rows_[std::min(at, rows_.size() - 1)].half_m;
    for (std::size_t side = 0; side < kHullSides; ++side) {
      const float turn_rad = kTurn_rad * static_cast<float>(side) / static_cast<float>(kHullSides);
      put(hull_[ring * kHullSides + side], half_m * std::cos(turn_rad), half_m * std::sin(turn_rad), v);
    }
  }
  put(hull_[kHullRings * kHullSides], 0.0F, 0.0F, 0.0F);
  put(hull_[kHullRings * kHullSides + 1], 0.0F, 0.0F, top_v);
}

}  // namespace yuragi::viewer::meshes
