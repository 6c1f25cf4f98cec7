#include "viewer/meshes/shadow_view.hpp"

#include <cmath>

#include <glm/gtc/matrix_transform.hpp>

namespace yuragi::viewer::meshes {
namespace {

constexpr float kMargin = 0.08F;  // of the box, for movement by the wind
constexpr float kEyeDistance_m = 1000.0F;
constexpr float kSunTangent = 0.012F;  // tangent of the angle of the sun's light: a little more than the disc

}  // namespace

View shadow_view(const Bounds& casters, const glm::vec3& to_sun, int texels) {
  const glm::vec3 middle = (casters.low_m + casters.high_m) / 2.0F;
  const glm::vec3 half = (casters.high_m - casters.low_m) * (0.5F + kMargin) + 0.1F;
  const glm::vec3 aside = std::abs(to_sun.y) > 0.99F ? glm::vec3(0.0F, 0.0F, -1.0F) : glm::vec3(0.0F, 1.0F, 0.0F);
  const glm::mat4 to_light = glm::lookAt(middle + to_sun * kEyeDistance_m, middle, aside);

  // The extent of the box along the light's axes.
  const auto extent = [&](int axis) {
    return std::abs(to_light[0][axis]) * half.x + std::abs(to_light[1][axis]) * half.y +
           std::abs(to_light[2][axis]) * half.z;
  };
  const float across_m = extent(0);
  const float upright_m = extent(1);
  const float deep_m = extent(2);

  View view;
  view.to_clip =
      glm::ortho(-across_m, across_m, -upright_m, upright_m, kEyeDistance_m - deep_m, kEyeDistance_m + deep_m) *
      to_light;
  const float texel_m = 2.0F * std::max(across_m, upright_m) / static_cast<float>(texels);
  view.eye_m = glm::vec4(middle + to_sun * kEyeDistance_m, texel_m / kEyeDistance_m);
  view.right = {to_light[0][0], to_light[1][0], to_light[2][0], 0.0F};
  view.up = {to_light[0][1], to_light[1][1], to_light[2][1], 0.0F};
  view.forward = {-to_light[0][2], -to_light[1][2], -to_light[2][2], 0.0F};
  // A penumbra grows to this share of the map's sides if the shadow falls one whole depth behind its object.
  view.shadow = {0.0F, kSunTangent * deep_m / across_m, kSunTangent * deep_m / upright_m, 2.0F * deep_m};
  return view;
}

void add_shadows(View& view, const View& shadows, int texels) {
  const glm::mat4 to_texture =
      glm::translate(glm::mat4(1.0F), glm::vec3(0.5F)) * glm::scale(glm::mat4(1.0F), glm::vec3(0.5F));
  view.to_shadow = to_texture * shadows.to_clip;
  view.shadow = {1.0F / static_cast<float>(texels), shadows.shadow.y, shadows.shadow.z, shadows.shadow.w};
}

View with_hard_shadows(View view) {
  view.shadow.y = view.shadow.z = 0.0F;
  return view;
}

}  // namespace yuragi::viewer::meshes
