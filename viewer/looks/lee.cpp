#include "viewer/looks/lee.hpp"

#include <algorithm>
#include <variant>

#include <glm/common.hpp>
#include <glm/trigonometric.hpp>

namespace yuragi::viewer::looks {
namespace {

constexpr float kCurtainPerHeight = 0.65F;
constexpr float kFlamePerHeight = 0.5F;

float height_m(const meshes::Bounds& bounds) {
  return bounds.high_m.y - bounds.low_m.y;
}

float reach_m(const pose::Skeleton& skeleton) {
  if (const auto* cloth = std::get_if<pose::GridSkeleton>(&skeleton)) {
    // A flag and a banner turn about their poles, in boxes that have room for it.
    if (cloth->columns == 0 || cloth->rows == 0 || cloth->is_first_column_fixed) return 0.0F;
    const bool is_hoisted = cloth->rest_y_m.front() != cloth->rest_y_m[cloth->columns - 1];
    return is_hoisted ? 0.0F : kCurtainPerHeight * height_m(meshes::bounds_of(*cloth));
  }
  const auto* surface = std::get_if<pose::SurfaceSkeleton>(&skeleton);
  return surface != nullptr && surface->moves_rows() ? kFlamePerHeight * height_m(meshes::bounds_of(*surface)) : 0.0F;
}

}  // namespace

meshes::Bounds with_lee(const meshes::Bounds& bounds, const pose::Skeleton& skeleton, double wind_from_deg) {
  const auto from_rad = static_cast<float>(glm::radians(wind_from_deg));
  const glm::vec3 lee_m = reach_m(skeleton) * glm::vec3(-glm::sin(from_rad), 0.0F, glm::cos(from_rad));
  return {bounds.low_m + glm::min(lee_m, 0.0F), bounds.high_m + glm::max(lee_m, 0.0F)};
}

}  // namespace yuragi::viewer::looks
