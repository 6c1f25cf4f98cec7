#include "viewer/wall/wall_pass.hpp"

#include <glm/gtc/type_ptr.hpp>

#include "viewer/gl/shaders.hpp"
#include "viewer/wall/window_map.hpp"

namespace yuragi::viewer::wall {

Pass::Pass() : program_(gl::link_program("wall", gl::shaders::kDoorVert, gl::shaders::kWallFrag)) {
  gl::set_sampler(program_, "picture", 0);
  const auto place = [this](const char* name) { return glGetUniformLocation(program_.name(), name); };
  monitor_px_ = place("monitor_px");
  to_crop_ = place("to_crop");
  crop_ = place("crop");
  blend_ = place("blend");
  gamma_ = place("gamma");
  is_marked_ = place("is_marked");
}

void Pass::take(const gl::RenderTarget& target) {
  glActiveTexture(GL_TEXTURE0);
  picture_.take(target);
}

void Pass::draw(const output::Window& window, const output::Size& monitor, GLuint vertex_array, bool is_marked) {
  glViewport(0, 0, monitor.width_px, monitor.height_px);
  glDisable(GL_DEPTH_TEST);
  glDisable(GL_BLEND);
  glUseProgram(program_.name());
  glActiveTexture(GL_TEXTURE0);
  glBindTexture(GL_TEXTURE_2D, picture_.texture());
  const auto number = [](double value) { return static_cast<float>(value); };
  const output::Crop& crop = window.crop;
  const output::Sides blend = blend_of_crop(window);
  const glm::mat3 to_crop(monitor_to_crop(window));
  glUniform2f(monitor_px_, static_cast<float>(monitor.width_px), static_cast<float>(monitor.height_px));
  glUniformMatrix3fv(to_crop_, 1, GL_FALSE, glm::value_ptr(to_crop));
  glUniform4f(crop_, number(crop.x), number(crop.y), number(crop.width), number(crop.height));
  glUniform4f(blend_, number(blend.left), number(blend.right), number(blend.top), number(blend.bottom));
  glUniform1f(gamma_, number(window.gamma));
  glUniform1i(is_marked_, is_marked ? 1 : 0);
  glBindVertexArray(vertex_array);
  glDrawArrays(GL_TRIANGLES, 0, 3);
}

}  // namespace yuragi::viewer::wall
