#pragma once

#include <cstdint>
#include <vector>

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

#include "engine/pose/skeleton.hpp"
#include "viewer/meshes/orbit_camera.hpp"

namespace yuragi::viewer::meshes {

/// The body under a coat: the ellipsoid, with one axis upright, that carries the roots of its hairs. A place p is on
/// its skin where dot(p - middle_m, shape * (p - middle_m)) is 1; shape * (p - middle_m) then points out of it.
struct Body {
  glm::vec3 middle_m{0.0F};
  glm::mat3 shape{1.0F};
  float spacing_m = 0.01F;  ///< mean spacing of its hairs
  float low_m = 0.0F;       ///< of the lowest root
  float hair_m = 0.0F;      ///< how long the hairs are, on average
  bool is_known = false;    ///< the roots do lie on an ellipsoid
};

/// By least squares; if the roots lie on no ellipsoid, one that fills the box around them. Pure.
Body body_of(const pose::StrandSkeleton& coat);

/// Returns the place, or the nearest one back along its view that is not in the body or among its hairs. Pure.
CameraPlace outside(const Body& body, const CameraPlace& place);

/// The skin, as rings of points (all around the ellipsoid) and the triangles between them, without the part below the
/// hairs.
struct Skin {
  std::vector<glm::vec3> places_m;
  std::vector<std::uint32_t> triangles;
};
Skin skin_of(const Body& body);

}  // namespace yuragi::viewer::meshes
