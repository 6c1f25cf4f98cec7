#pragma once

#include <glm/common.hpp>
#include <glm/vec3.hpp>

namespace yuragi::viewer::meshes::trees {

/// The position of a copy of a tree: turned about the vertical axis through its own foot, scaled, and moved.
struct Place {
  glm::vec3 from_m{0.0F};  ///< the foot of the tree that is copied
  glm::vec3 to_m{0.0F};    ///< the foot of the copy
  float cosine = 1.0F;     ///< of the turn, clockwise from above
  float sine = 0.0F;
  float scale = 1.0F;

  /// Number from 0 to 1 by which the copied tree and its copies differ. Spread as evenly as places are (M. Roberts
  /// 2018, "The unreasonable effectiveness of quasirandom sequences").
  float chance() const {
    const glm::vec3 way_m = to_m - from_m;
    return glm::fract(0.5F + 7.548777F * way_m.x + 5.698403F * way_m.z);
  }
  glm::vec3 turned(const glm::vec3& v) const { return {cosine * v.x - sine * v.z, v.y, sine * v.x + cosine * v.z}; }
  glm::vec3 moved(const glm::vec3& place_m) const { return to_m + scale * turned(place_m - from_m); }
};

}  // namespace yuragi::viewer::meshes::trees
