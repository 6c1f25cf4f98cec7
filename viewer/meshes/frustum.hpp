#pragma once

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

namespace yuragi::viewer::meshes {

/// The view of a camera, as tangents of the angles between its direction of view and the picture's sides. A camera that
/// looks at right angles through the middle of its picture has left = -right and bottom = -top.
struct Frustum {
  double left = -1.0;
  double right = 1.0;
  double bottom = -1.0;
  double top = 1.0;
};

/// The view of an eye through a screen, perpendicular to it; the eye need not be before the screen's middle.
/// Right-handed axes, metres. (R. Kooima, "Generalized Perspective Projection", 2009.) The screen is a rectangle, and
/// the eye is in front of it.
Frustum frustum_through(const glm::dvec3& lower_left_m, const glm::dvec3& lower_right_m, const glm::dvec3& upper_left_m,
                        const glm::dvec3& eye_m);

/// From the camera's space to clip space.
glm::dmat4 projection_of(const Frustum& frustum, double near_m, double far_m);

}  // namespace yuragi::viewer::meshes
