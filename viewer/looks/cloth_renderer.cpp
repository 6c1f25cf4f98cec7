#include "viewer/looks/cloth_renderer.hpp"

#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

#include "viewer/gl/shaders.hpp"

namespace yuragi::viewer::looks {
namespace {

/// From a banner's pole to the end of its arm along the ground, at rest and in a pose.
glm::vec2 arm_m(const pose::GridSkeleton& cloth, const pose::GridPose* pose) {
  const std::size_t end = cloth.columns - 1;
  const glm::vec2 at_rest_m(cloth.rest_x_m[end] - cloth.rest_x_m[0], cloth.rest_z_m[end] - cloth.rest_z_m[0]);
  return pose == nullptr ? at_rest_m : at_rest_m + glm::vec2(pose->offset_x_m[end], pose->offset_z_m[end]);
}

}  // namespace

ClothRenderer::ClothRenderer(const pose::GridSkeleton& cloth, std::string_view kind)
    : cloth_(&cloth),
      is_vane_(meshes::cloth_style(kind, cloth) == meshes::ClothStyle::kBanner && cloth.columns > 1 && cloth.rows > 0),
      points_(cloth),
      sheet_(meshes::layout_of(cloth)),
      holder_(meshes::cloth_holder(meshes::cloth_style(kind, cloth), cloth)),
      program_(gl::link_program("cloth", gl::shaders::kClothVert, gl::shaders::kClothFrag)) {
  const meshes::ClothMeasure lies = meshes::measure(cloth);
  const auto place = [&](const char* name) { return glGetUniformLocation(program_.name(), name); };
  glUseProgram(program_.name());
  glUniform1i(place("stride"), static_cast<GLint>(cloth.stride()));
  glUniform2f(place("origin_m"), lies.origin_m.x, lies.origin_m.y);
  glUniform2f(place("per_column_m"), lies.per_column_m.x, lies.per_column_m.y);
  glUniform2f(place("per_row_m"), lies.per_row_m.x, lies.per_row_m.y);
  glUniform2f(place("size_m"), lies.size_m.x, lies.size_m.y);
  glUniform1i(place("style"), static_cast<GLint>(meshes::cloth_style(kind, cloth)));
}

void ClothRenderer::move_to(const pose::Pose& pose) {
  const auto* const offsets = std::get_if<pose::GridPose>(&pose);
  const pose::GridKinematicsJob job{.skeleton = cloth_, .pose = offsets, .points = &points_};
  if (job.run() != pose::GridKinematicsJob::Problem::kNone) return;
  sheet_.move_to(std::as_const(points_).data());
  if (!is_vane_) return;
  const glm::vec2 rest_m = arm_m(*cloth_, nullptr);
  const glm::vec2 now_m = arm_m(*cloth_, offsets);
  const float square_m2 = glm::length(rest_m) * glm::length(now_m);
  if (!(square_m2 > 0.0F)) return;
  holder_.turn({cloth_->rest_x_m[0], cloth_->rest_z_m[0]}, (rest_m.x * now_m.y - rest_m.y * now_m.x) / square_m2,
               glm::dot(rest_m, now_m) / square_m2);
}

void ClothRenderer::draw(const meshes::View&) {
  glUseProgram(program_.name());
  sheet_.draw();
  holder_.draw();
}

}  // namespace yuragi::viewer::looks
