#pragma once

#include <glm/common.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "viewer/meshes/bounds.hpp"

namespace yuragi::viewer::meshes {

/// A level floor of boards over the ground, without grass.
struct Floor {
  glm::vec3 middle_m{0.0F};     ///< of its upper side
  glm::vec2 along{1.0F, 0.0F};  ///< x, z: a unit vector perpendicular to its boards
  glm::vec2 half_m{0.0F};       ///< along it, and along its boards
  friend bool operator==(const Floor&, const Floor&) = default;
};

/// Returns true if a place on the ground (x, z) is on it, or at most `beyond_m` from it along either side.
inline bool is_on(const Floor& floor, const glm::vec2& at_m, float beyond_m) {
  const glm::vec2 way = at_m - glm::vec2(floor.middle_m.x, floor.middle_m.z);
  const float aside_m = way.x * floor.along.x + way.y * floor.along.y;
  const float ahead_m = way.y * floor.along.x - way.x * floor.along.y;
  return aside_m <= floor.half_m.x + beyond_m && -aside_m <= floor.half_m.x + beyond_m &&
         ahead_m <= floor.half_m.y + beyond_m && -ahead_m <= floor.half_m.y + beyond_m;
}

/// The flat box around it.
inline Bounds bounds_of(const Floor& floor) {
  const glm::vec2 aside = glm::abs(floor.along);
  const glm::vec3 half_m(aside.x * floor.half_m.x + aside.y * floor.half_m.y, 0.0F,
                         aside.y * floor.half_m.x + aside.x * floor.half_m.y);
  return {floor.middle_m - half_m, floor.middle_m + half_m};
}

}  // namespace yuragi::viewer::meshes
