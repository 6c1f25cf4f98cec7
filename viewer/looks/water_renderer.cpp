#include "viewer/looks/water_renderer.hpp"

#include <algorithm>
#include <array>

#include <glm/geometric.hpp>

#include "viewer/gl/shaders.hpp"

namespace yuragi::viewer::looks {
namespace {

const glm::vec3 kStone(0.23F, 0.21F, 0.18F);
constexpr float kHalfRimPerSide = 0.02F;  // half the rim's width, of the longest side
constexpr float kRimRise_m = 0.06F;       // above the water at rest
constexpr float kBasinDepth_m = 0.6F;

std::array<glm::vec3, 4> corners_of(const pose::SurfaceSkeleton& surface) {
  const std::size_t columns = surface.columns;
  const std::size_t last = columns * (surface.rows - 1);
  const auto corner = [&](std::size_t i) {
    return glm::vec3(surface.rest_x_m[i], surface.rest_y_m[i], surface.rest_z_m[i]);
  };
  return {corner(0), corner(columns - 1), corner(last + columns - 1), corner(last)};
}

bool is_open_sheet(const pose::SurfaceSkeleton& surface) {
  return surface.columns > 1 && surface.rows > 1 && !surface.is_closed;
}

}  // namespace

meshes::SolidMesh water_basin(const pose::SurfaceSkeleton& surface) {
  meshes::SolidMesh basin;
  if (!is_open_sheet(surface)) return basin;
  const std::array<glm::vec3, 4> corners = corners_of(surface);
  const glm::vec3 middle = (corners[0] + corners[2]) / 2.0F;
  const float side_m = std::max(glm::distance(corners[0], corners[1]), glm::distance(corners[1], corners[2]));
  const float half_m = std::clamp(kHalfRimPerSide * side_m, 0.02F, 0.2F);
  const float low_m = std::min(0.0F, middle.y) - kBasinDepth_m;

  // The rim stands outside of the water: its inner side is the water's edge.
  for (std::size_t i = 0; i < 4; ++i) {
    const glm::vec3 along = corners[(i + 1) % 4] - corners[i];
    if (glm::length(along) <= 0.0F) continue;
    const glm::vec3 forward = half_m * glm::normalize(along);
    glm::vec3 out(-forward.z, 0.0F, forward.x);
    if (glm::dot(out, corners[i] - middle) < 0.0F) out = -out;
    basin.add_beam(corners[i] + out - 2.0F * forward, corners[(i + 1) % 4] + out + 2.0F * forward, half_m, low_m,
                   middle.y + kRimRise_m, kStone);
  }
  return basin;
}

meshes::SolidMesh water_hole(const pose::SurfaceSkeleton& surface) {
  meshes::SolidMesh hole;
  if (!is_open_sheet(surface)) return hole;
  std::array<glm::vec3, 4> corners = corners_of(surface);
  for (glm::vec3& corner : corners) corner.y = 0.0F;
  hole.add_quad(corners, {});
  return hole;
}

WaterRenderer::WaterRenderer(const pose::SurfaceSkeleton& surface)
    : surface_(&surface),
      points_(surface),
      sheet_(meshes::layout_of(surface)),
      basin_(water_basin(surface)),
      hole_(water_hole(surface)),
      program_(gl::link_program("water", gl::shaders::kWaterVert, gl::shaders::kWaterFrag)) {}

void WaterRenderer::move_to(const pose::Pose& pose) {
  const auto* const waves = std::get_if<pose::SurfacePose>(&pose);
  const pose::SurfaceKinematicsJob job{.skeleton = surface_, .pose = waves, .points = &points_};
  if (job.run() == pose::SurfaceKinematicsJob::Problem::kNone) sheet_.move_to(std::as_const(points_).data());
}

void WaterRenderer::draw(const meshes::View&) {
  glUseProgram(program_.name());
  sheet_.draw();
  basin_.draw();
}

void WaterRenderer::draw_hole() {
  hole_.draw();
}

}  // namespace yuragi::viewer::looks
