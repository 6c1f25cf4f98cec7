#include "viewer/looks/flame_renderer.hpp"

#include <algorithm>

#include <glm/geometric.hpp>

#include "viewer/gl/shaders.hpp"
#include "viewer/meshes/bounds.hpp"

namespace yuragi::viewer::looks {
namespace {

const glm::vec3 kIron(0.030F, 0.027F, 0.025F);
const glm::vec3 kEmbers(0.95F, 0.22F, 0.035F);
constexpr std::size_t kRampColors = 256;
constexpr float kGlowPerHeight = 1.15F;  // the glow's radius

}  // namespace

meshes::SolidMesh flame_bowl(const pose::SurfaceSkeleton& surface) {
  meshes::SolidMesh bowl;
  if (surface.rest_x_m.empty()) return bowl;
  const meshes::Bounds bounds = meshes::bounds_of(surface);
  const glm::vec3 size_m = bounds.high_m - bounds.low_m;
  const float foot_m = *std::min_element(surface.rest_y_m.begin(), surface.rest_y_m.end());

  // As wide as the flame in its lowest tenth.
  meshes::Bounds foot{glm::vec3(1e9F), glm::vec3(-1e9F)};
  for (std::size_t i = 0; i < surface.rest_x_m.size(); ++i) {
    const glm::vec3 point(surface.rest_x_m[i], surface.rest_y_m[i], surface.rest_z_m[i]);
    if (point.y < foot_m + 0.1F * size_m.y) foot = united(foot, {point, point});
  }
  const glm::vec3 middle = (foot.low_m + foot.high_m) / 2.0F;
  // (A flat sheet is wider, so that its flames have room to lean; they burn from its middle.)
  const float share = surface.is_closed ? 0.55F : 0.09F;
  const float radius_m = share * std::max(foot.high_m.x - foot.low_m.x, foot.high_m.z - foot.low_m.z) + 0.03F;
  const auto at = [&](float y_m) { return glm::vec3(middle.x, y_m, middle.z); };
  const float rim_m = foot_m + 0.25F * radius_m;
  const float depth_m = 0.45F * radius_m;
  bowl.add_tube(at(rim_m - depth_m), at(rim_m - 0.4F * depth_m), 0.45F * radius_m, 0.85F * radius_m, kIron);
  bowl.add_tube(at(rim_m - 0.4F * depth_m), at(rim_m), 0.85F * radius_m, radius_m, kIron);
  bowl.add_tube(at(rim_m - 0.15F * depth_m), at(rim_m - 0.35F * depth_m), radius_m * 0.97F, 0.0F, kEmbers);
  if (rim_m - depth_m > 0.0F) {
    bowl.add_tube(at(0.0F), at(rim_m - 0.9F * depth_m), 0.14F * radius_m, 0.12F * radius_m, kIron);
    bowl.add_tube(at(0.0F), at(0.08F * radius_m), 0.6F * radius_m, 0.14F * radius_m, kIron);
  }
  return bowl;
}

FlameRenderer::FlameRenderer(const pose::SurfaceSkeleton& surface)
    : surface_(&surface),
      points_(surface),
      sheet_(meshes::layout_of(surface)),
      bowl_(flame_bowl(surface)),
      program_(gl::link_program("flame", gl::shaders::kFlameVert, gl::shaders::kFlameFrag)),
      glow_program_(gl::link_program("glow", gl::shaders::kGlowVert, gl::shaders::kGlowFrag)) {
  glBindTexture(GL_TEXTURE_2D, ramp_.name());
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, kRampColors, 1, 0, GL_RGBA, GL_UNSIGNED_BYTE,
               surface.ramp_rgba.size() == 4 * kRampColors ? surface.ramp_rgba.data() : nullptr);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  gl::set_sampler(program_, "ramp", 0);
  glUniform1i(glGetUniformLocation(program_.name(), "is_closed"), surface.is_closed ? 1 : 0);

  glUniform1i(glGetUniformLocation(program_.name(), "columns"), static_cast<GLint>(surface.columns));
  glUniform1i(glGetUniformLocation(program_.name(), "shells"), static_cast<GLint>(sheet_.shells()));
  glUniform1i(glGetUniformLocation(program_.name(), "rows"), static_cast<GLint>(surface.rows));

  const meshes::Bounds bounds = meshes::bounds_of(surface);
  glow_radius_m_ = kGlowPerHeight * (bounds.high_m.y - bounds.low_m.y);
  glow_middle_m_ = (bounds.low_m + bounds.high_m) / 2.0F;
  glow_ball_place_ = glGetUniformLocation(glow_program_.name(), "ball_m");
  glow_strength_place_ = glGetUniformLocation(glow_program_.name(), "strength");
}

void FlameRenderer::move_to(const pose::Pose& pose) {
  const auto* const burning = std::get_if<pose::SurfacePose>(&pose);
  const pose::SurfaceKinematicsJob job{.skeleton = surface_, .pose = burning, .points = &points_};
  if (job.run() != pose::SurfaceKinematicsJob::Problem::kNone || burning->heat.size() != points_.size()) return;
  sheet_.move_to(std::as_const(points_).data());
  sheet_.set_level(burning->heat);

  // The glow's middle is that of the heat.
  float heat = 0.0F;
  glm::vec3 sum_m(0.0F);
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const pose::JointPosition at = points_.point(i);
    heat += burning->heat[i];
    sum_m += burning->heat[i] * glm::vec3(at.x_m, at.y_m, at.z_m);
  }
  strength_ = heat / static_cast<float>(std::max<std::size_t>(1, burning->heat.size()));
  if (heat > 0.0F) glow_middle_m_ = sum_m / heat;
}

void FlameRenderer::draw(const meshes::View&) {
  bowl_.draw();
}

void FlameRenderer::draw_light() {
  glEnable(GL_BLEND);
  glDepthMask(GL_FALSE);

  // A glow adds to what is behind it.
  glBlendFunc(GL_ONE, GL_ONE);
  glUseProgram(glow_program_.name());
  glUniform1f(glow_strength_place_, strength_);
  glUniform4f(glow_ball_place_, glow_middle_m_.x, glow_middle_m_.y, glow_middle_m_.z, glow_radius_m_);
  glBindVertexArray(no_attributes_.name());
  glDrawArrays(GL_TRIANGLE_STRIP, 0, 4);

  // The far side of a body is drawn before the near one, and the inner shells between the two sides of the outer.
  glBlendFunc(GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
  glUseProgram(program_.name());
  glActiveTexture(GL_TEXTURE0);
  glBindTexture(GL_TEXTURE_2D, ramp_.name());
  if (surface_->is_closed) {
    glEnable(GL_CULL_FACE);
    glCullFace(GL_FRONT);
    for (std::size_t shell = 0; shell < sheet_.shells(); ++shell) sheet_.draw_shell(shell);
    glCullFace(GL_BACK);
    for (std::size_t shell = sheet_.shells(); shell-- > 0;) sheet_.draw_shell(shell);
    glDisable(GL_CULL_FACE);
  } else {
    sheet_.draw();
  }

  glDepthMask(GL_TRUE);
  glDisable(GL_BLEND);
}

}  // namespace yuragi::viewer::looks
