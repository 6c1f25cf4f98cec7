#pragma once

#include <array>

#include <glm/gtc/constants.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "viewer/meshes/orbit_camera.hpp"

namespace yuragi::viewer::meshes {

/// The data of all renderers about the picture being drawn: the uniform block View of viewer/gl/shaders/common.glsl, in
/// its layout (std140).
struct View {
  glm::mat4 to_clip{1.0F};
  glm::vec4 eye_m{0.0F};  ///< w: the size of a pixel at a distance of one metre, metres
  glm::vec4 right{0.0F};  ///< unit vectors of the camera; w: tangent of half the field of view, horizontally
  glm::vec4 up{0.0F};     ///< w: the same, vertically
  /// Toward the picture's middle: for a camera that looks through it at right angles a unit vector, otherwise of length
  /// 1 along the camera's axis; w: mean density of the mist between the eye's height and the ground, on which it is 1
  glm::vec4 forward{0.0F};
  glm::mat4 to_shadow{1.0F};  ///< to the shadow map: place and depth, 0 to 1
  /// Size of a texel of the map (0: no map); growth of a penumbra, across and upright (0: none); the map's depth, m
  /// (and no texel: a shadow is being drawn, without color).
  glm::vec4 shadow{0.0F};
};

/// For a picture of this size in pixels.
View view_of(const OrbitCamera& camera, int width_px, int height_px);

/// From the eye through the corners of a picture that is `margin` times as wide and as high.
std::array<glm::vec3, 4> corner_rays(const View& view, float margin = 1.0F);

/// Bearings from one on clockwise, seen from above; 0 is along -z.
struct Arc {
  float from_rad = 0.0F;                  ///< 0 to a turn
  float size_rad = glm::two_pi<float>();  ///< at most a turn
};

/// The bearings of all directions in a picture that is `margin` times as wide and as high; the full circle if straight
/// up or straight down can be among them.
Arc bearings_of(const View& view, float margin = 1.0F);

/// The arc, extended on both sides, radians.
Arc widened(const Arc& arc, float by_rad);

/// The planes of the picture's sides and of its near side: dot(plane, (x, y, z, 1)) is a point's distance inside,
/// metres. From the rows of the projection (Gribb and Hartmann 2001, "Fast extraction of viewing frustum planes from
/// the world-view-projection matrix").
std::array<glm::vec4, 5> side_planes(const View& view);

/// Returns false if a box is certainly outside of these planes.
bool is_in_view(const std::array<glm::vec4, 5>& planes, const glm::vec3& low_m, const glm::vec3& high_m);

/// The view of the image in a level mirror at this height, with a margin all around: a thing is at the place of its
/// mirror image in `view`, its distance from the middle divided by kMirrorMargin. `pixels`: for each pixel of `view`.
inline constexpr float kMirrorMargin = 1.25F;  // water.frag.glsl has the same number
View mirrored(const View& view, float height_m, float pixels);

}  // namespace yuragi::viewer::meshes
