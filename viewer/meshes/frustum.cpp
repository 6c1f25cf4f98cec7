#include "viewer/meshes/frustum.hpp"

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>

namespace yuragi::viewer::meshes {

Frustum frustum_through(const glm::dvec3& lower_left_m, const glm::dvec3& lower_right_m, const glm::dvec3& upper_left_m,
                        const glm::dvec3& eye_m) {
  const glm::dvec3 right = glm::normalize(lower_right_m - lower_left_m);
  const glm::dvec3 up = glm::normalize(upper_left_m - lower_left_m);
  const glm::dvec3 to_eye = glm::normalize(glm::cross(right, up));
  const double distance_m = glm::dot(to_eye, eye_m - lower_left_m);
  return {.left = glm::dot(right, lower_left_m - eye_m) / distance_m,
          .right = glm::dot(right, lower_right_m - eye_m) / distance_m,
          .bottom = glm::dot(up, lower_left_m - eye_m) / distance_m,
          .top = glm::dot(up, upper_left_m - eye_m) / distance_m};
}

glm::dmat4 projection_of(const Frustum& frustum, double near_m, double far_m) {
  return glm::frustum(frustum.left * near_m, frustum.right * near_m, frustum.bottom * near_m, frustum.top * near_m,
                      near_m, far_m);
}

}  // namespace yuragi::viewer::meshes
