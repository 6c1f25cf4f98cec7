#pragma once

#include <glm/vec3.hpp>

namespace yuragi::viewer::meshes {

/// Where a copy of a tree stands: turned about the upright axis through its own foot, scaled, and moved.
struct TreePlace {
  glm::vec3 from_m{0.0F};  ///< the foot of the tree that is copied
  glm::vec3 to_m{0.0F};    ///< the foot of the copy
  float cosine = 1.0F;     ///< of the turn, clockwise from above
  float sine = 0.0F;
  float scale = 1.0F;

  glm::vec3 turned(const glm::vec3& v) const { return {cosine * v.x - sine * v.z, v.y, sine * v.x + cosine * v.z}; }
  glm::vec3 moved(const glm::vec3& place_m) const { return to_m + scale * turned(place_m - from_m); }
};

}  // namespace yuragi::viewer::meshes
