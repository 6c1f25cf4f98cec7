#include "viewer/meshes/view.hpp"

#include <algorithm>
#include <cmath>

#include <glm/trigonometric.hpp>

namespace yuragi::viewer::meshes {
namespace {

constexpr double kMistHeight_m = 110.0;  // mist is thinner by a factor of e there (common.glsl)

/// The mean of exp(-height / kMistHeight_m) from the ground to a height.
float mist_below(double height_m) {
  const double part = std::max(height_m / kMistHeight_m, 1e-4);
  return static_cast<float>(-std::expm1(-part) / part);
}

}  // namespace

View view_of(const OrbitCamera& camera, int width_px, int height_px) {
  const float aspect = static_cast<float>(width_px) / static_cast<float>(height_px);
  const Frustum frustum = camera.frustum(static_cast<double>(aspect));
  const auto tan_up = static_cast<float>(0.5 * (frustum.top - frustum.bottom));
  const auto tan_right = static_cast<float>(0.5 * (frustum.right - frustum.left));
  // The picture's middle, relative to the camera's axis.
  const auto middle_up = static_cast<float>(0.5 * (frustum.top + frustum.bottom));
  const auto middle_right = static_cast<float>(0.5 * (frustum.right + frustum.left));
  const glm::mat4 to_camera = camera.view();

  View view;
  view.to_clip = camera.projection(static_cast<double>(aspect)) * to_camera;
  view.eye_m = glm::vec4(glm::vec3(camera.eye_m()), 2.0F * tan_up / static_cast<float>(height_px));
  // The rows of the rotation are the camera's axes in the world.
  view.right = {to_camera[0][0], to_camera[1][0], to_camera[2][0], tan_right};
  view.up = {to_camera[0][1], to_camera[1][1], to_camera[2][1], tan_up};
  view.forward = {-to_camera[0][2], -to_camera[1][2], -to_camera[2][2], mist_below(camera.eye_m().y)};
  view.forward += glm::vec4(middle_right * glm::vec3(view.right) + middle_up * glm::vec3(view.up), 0.0F);
  return view;
}

std::array<glm::vec3, 4> corner_rays(const View& view, float margin) {
  const glm::vec3 aside = margin * view.right.w * glm::vec3(view.right);
  const glm::vec3 above = margin * view.up.w * glm::vec3(view.up);
  const glm::vec3 forward(view.forward);
  return {forward - aside - above, forward - aside + above, forward + aside - above, forward + aside + above};
}

Arc bearings_of(const View& view, float margin) {
  constexpr float kMaxSteep = 0.2F;  // minimum part of a corner's direction along the middle's bearing
  const glm::vec3 forward(view.forward);
  const float level = std::hypot(forward.x, forward.z);
  if (level < kMaxSteep * glm::length(forward)) return {};
  const float heading_rad = std::atan2(forward.x, -forward.z);
  float left_rad = 0.0F;
  float right_rad = 0.0F;
  for (const glm::vec3& ray : corner_rays(view, margin)) {
    if (ray.x * forward.x + ray.z * forward.z < kMaxSteep * level * glm::length(ray)) return {};
    const float turn_rad = std::remainder(std::atan2(ray.x, -ray.z) - heading_rad, glm::two_pi<float>());
    left_rad = std::min(left_rad, turn_rad);
    right_rad = std::max(right_rad, turn_rad);
  }
  return widened({.from_rad = heading_rad + left_rad, .size_rad = right_rad - left_rad}, 0.0F);
}

Arc widened(const Arc& arc, float by_rad) {
  const float turn_rad = glm::two_pi<float>();
  const float from_rad = arc.from_rad - by_rad;
  const float size_rad = arc.size_rad + 2.0F * by_rad;
  if (size_rad >= turn_rad) return {};
  return {.from_rad = from_rad - turn_rad * std::floor(from_rad / turn_rad), .size_rad = size_rad};
}

std::array<glm::vec4, 5> side_planes(const View& view) {
  const auto row = [&](int i) {
    return glm::vec4(view.to_clip[0][i], view.to_clip[1][i], view.to_clip[2][i], view.to_clip[3][i]);
  };
  std::array<glm::vec4, 5> planes{row(3) + row(0), row(3) - row(0), row(3) + row(1), row(3) - row(1), row(3) + row(2)};
  for (glm::vec4& plane : planes) plane /= glm::length(glm::vec3(plane));
  return planes;
}

bool is_in_view(const std::array<glm::vec4, 5>& planes, const glm::vec3& low_m, const glm::vec3& high_m) {
  // The corner that is farthest inside of each.
  return std::all_of(planes.begin(), planes.end(), [&](const glm::vec4& plane) {
    const glm::vec3 corner(plane.x > 0.0F ? high_m.x : low_m.x, plane.y > 0.0F ? high_m.y : low_m.y,
                           plane.z > 0.0F ? high_m.z : low_m.z);
    return glm::dot(plane, glm::vec4(corner, 1.0F)) >= 0.0F;
  });
}

View mirrored(const View& view, float height_m, float pixels) {
  glm::mat4 mirror(1.0F);
  mirror[1].y = -1.0F;
  mirror[3].y = 2.0F * height_m;
  glm::mat4 margin(1.0F);
  margin[0].x = margin[1].y = 1.0F / kMirrorMargin;
  View image = view;
  image.to_clip = margin * view.to_clip * mirror;
  image.eye_m.y = 2.0F * height_m - view.eye_m.y;
  image.eye_m.w *= kMirrorMargin / pixels;
  image.right.w *= kMirrorMargin;
  image.up.w *= kMirrorMargin;
  for (glm::vec4* axis : {&image.right, &image.up, &image.forward}) axis->y = -axis->y;
  return image;
}

}  // namespace yuragi::viewer::meshes
