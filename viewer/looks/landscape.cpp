#include "viewer/looks/landscape.hpp"

#include "viewer/gl/noise_texture.hpp"
#include "viewer/gl/screen_door.hpp"
#include "viewer/gl/shaders.hpp"
#include "viewer/looks/ground_maps.hpp"

namespace yuragi::viewer::looks {
namespace {

// The shaders have the same numbers.
constexpr GLsizei kHillSteps = 2160;
constexpr GLsizei kHillLines = 3;
constexpr GLsizei kSkyColumns = 40;
constexpr GLsizei kSkyRows = 24;

constexpr float kSunInShadow = 0.22F;  // leaves, threads and the air let some through

}  // namespace

Landscape::Landscape()
    : noise_(gl::make_noise_texture()),
      ground_(gl::link_program("ground", gl::shaders::kGroundVert, gl::shaders::kGroundFrag)),
      hills_(gl::link_program("hills", gl::shaders::kHillsVert, gl::shaders::kShadeFrag)),
      sky_(gl::link_program("sky", gl::shaders::kSkyVert, gl::shaders::kSkyFrag)) {
  GroundMaps::set_samplers(ground_);
  sunlight_place_ = glGetUniformLocation(ground_.name(), "sunlight");
  gl::set_sampler(sky_, "noise_tile", 0);
}

void Landscape::draw() {
  glBindVertexArray(no_attributes_.name());
  glUseProgram(ground_.name());
  glEnable(GL_STENCIL_TEST);
  glStencilOp(GL_KEEP, GL_KEEP, GL_KEEP);
  for (const GLuint shadow : {GLuint{0}, gl::kShadow}) {
    glStencilFunc(GL_EQUAL, static_cast<GLint>(shadow), gl::kHole | gl::kShadow);
    glUniform1f(sunlight_place_, shadow == 0 ? 1.0F : kSunInShadow);
    glDrawArrays(GL_TRIANGLE_STRIP, 0, 4);
  }
  glDisable(GL_STENCIL_TEST);
  draw_sky();
}

void Landscape::draw_sky() {
  glBindVertexArray(no_attributes_.name());
  glActiveTexture(GL_TEXTURE0);
  glBindTexture(GL_TEXTURE_2D, noise_.name());
  // From near to far; the sky is at the far end of the depth range.
  glUseProgram(hills_.name());
  glDrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 2 * (kHillSteps + 1), kHillLines);
  glDepthFunc(GL_LEQUAL);
  glUseProgram(sky_.name());
  glDrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 2 * (kSkyColumns + 1), kSkyRows);
  glDepthFunc(GL_LESS);
}

}  // namespace yuragi::viewer::looks
