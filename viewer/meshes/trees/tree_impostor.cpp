#include "viewer/meshes/trees/tree_impostor.hpp"

#include <algorithm>
#include <cmath>

#include <glm/common.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include "engine/base/units.hpp"

namespace yuragi::viewer::meshes::trees {
namespace {

constexpr float kImpostorEye_m = 1000.0F;
constexpr float kFadesOver = 1.25F;

}  // namespace

ImpostorBox impostor_box(const Bounds& tree) {
  const glm::vec3 half_m = 0.5F * (tree.high_m - tree.low_m);
  const float radius_m = std::max({half_m.x, half_m.z, 0.05F});
  // Seen from above its top is higher in the picture, by its radius.
  return {.middle_m = 0.5F * (tree.low_m + tree.high_m),
          .half_width_m = 1.02F * radius_m,
          .half_height_m = 1.02F * std::hypot(std::max(half_m.y, 0.05F), radius_m)};
}

View impostor_view(const ImpostorBox& box, std::size_t side, std::size_t row, int side_px) {
  const float around_rad =
      static_cast<float>(2.0 * kPi) * static_cast<float>(side) / static_cast<float>(kImpostorSides);
  const float height_rad = kMinImpostor_rad + kImpostorStep_rad * static_cast<float>(row);
  const glm::vec3 to_eye(std::cos(height_rad) * std::sin(around_rad), std::sin(height_rad),
                         std::cos(height_rad) * std::cos(around_rad));
  const glm::mat4 to_eye_space =
      glm::lookAt(box.middle_m + kImpostorEye_m * to_eye, box.middle_m, glm::vec3(0.0F, 1.0F, 0.0F));
  const float deep_m = 2.0F * std::max(box.half_width_m, box.half_height_m);
  View view;
  view.to_clip = glm::ortho(-box.half_width_m, box.half_width_m, -box.half_height_m, box.half_height_m,
                            kImpostorEye_m - deep_m, kImpostorEye_m + deep_m) *
                 to_eye_space;
  const float pixel_m = 2.0F * std::max(box.half_width_m, box.half_height_m) / static_cast<float>(side_px);
  view.eye_m = glm::vec4(box.middle_m + kImpostorEye_m * to_eye, pixel_m / kImpostorEye_m);
  for (int axis = 0; axis < 3; ++axis) {
    view.right[axis] = to_eye_space[axis][0];
    view.up[axis] = to_eye_space[axis][1];
    view.forward[axis] = -to_eye_space[axis][2];
  }
  return view;
}

float impostor_share(float height_px, float largest_px) {
  return std::clamp((kFadesOver * largest_px - height_px) / ((kFadesOver - 1.0F) * largest_px), 0.0F, 1.0F);
}

}  // namespace yuragi::viewer::meshes::trees
