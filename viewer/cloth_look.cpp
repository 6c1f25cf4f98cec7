#include "viewer/cloth_look.hpp"

#include "viewer/shaders.hpp"

namespace yuragi {

ClothLook::ClothLook(const GridSkeleton& cloth, std::string_view kind)
    : cloth_(&cloth),
      points_(cloth),
      sheet_(layout_of(cloth)),
      holder_(cloth_holder(cloth_style(kind, cloth), cloth)),
      program_(link_program("cloth", shaders::kClothVert, shaders::kClothFrag)) {
  const ClothMeasure lies = measure(cloth);
  const auto place = [&](const char* name) { return glGetUniformLocation(program_.name(), name); };
  glUseProgram(program_.name());
  glUniform1i(place("stride"), static_cast<GLint>(cloth.stride()));
  glUniform2f(place("origin_m"), lies.origin_m.x, lies.origin_m.y);
  glUniform2f(place("per_column_m"), lies.per_column_m.x, lies.per_column_m.y);
  glUniform2f(place("per_row_m"), lies.per_row_m.x, lies.per_row_m.y);
  glUniform2f(place("size_m"), lies.size_m.x, lies.size_m.y);
  glUniform1i(place("style"), static_cast<GLint>(cloth_style(kind, cloth)));
}

void ClothLook::move_to(const Pose& pose) {
  const auto* const offsets = std::get_if<GridPose>(&pose);
  const GridKinematicsJob job{.skeleton = cloth_, .pose = offsets, .points = &points_};
  if (job.run() == GridKinematicsJob::Problem::kNone) sheet_.move_to(std::as_const(points_).data());
}

void ClothLook::draw(const View&) {
  glUseProgram(program_.name());
  sheet_.draw();
  holder_.draw();
}

}  // namespace yuragi
