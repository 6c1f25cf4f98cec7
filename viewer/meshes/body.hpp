#pragma once

#include <cstdint>
#include <vector>

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

#include "engine/pose/skeleton.hpp"
#include "viewer/meshes/orbit_camera.hpp"

namespace yuragi::viewer::meshes {

/// The body under a coat: the ellipsoid with one axis upright on which the roots of its hairs stand. A place p is on
/// its skin where dot(p - middle_m, shape * (p - middle_m)) is 1; shape * (p - middle_m) is then the way out of it.
struct Body {
  glm::vec3 middle_m{0.0F};
  glm::mat3 shape{1.0F};
  float spacing_m = 0.01F;  ///< of the hairs on it, on average
  float low_m = 0.0F;       ///< of the lowest root
  float hair_m = 0.0F;      ///< how long the hairs are, on average
  bool is_known = false;    ///< the roots do stand on an ellipsoid
};

/// By least squares; where the roots stand on no ellipsoid, one that fills the box around them. Pure.
Body body_of(const pose::StrandSkeleton& coat);

/// The place, or one farther back along its view from which a camera does not stand in the body or among its hairs.
/// Pure.
CameraPlace outside(const Body& body, const CameraPlace& place);

/// The skin, as rings of points (all around the ellipsoid) and the triangles between them, but for what lies below the
/// hairs.
struct Skin {
  std::vector<glm::vec3> places_m;
  std::vector<std::uint32_t> triangles;
};
Skin skin_of(const Body& body);

}  // namespace yuragi::viewer::meshes
