#include "viewer/gl/dimmer.hpp"

#include "viewer/gl/shaders.hpp"

namespace yuragi::viewer::gl {

Dimmer::Dimmer() : program_(link_program("dim", shaders::kDoorVert, shaders::kDimFrag)) {}

void Dimmer::draw(float brightness) {
  if (brightness >= 1.0F) return;
  glDisable(GL_DEPTH_TEST);
  glEnable(GL_BLEND);
  glBlendColor(brightness, brightness, brightness, 1.0F);
  glBlendFunc(GL_ZERO, GL_CONSTANT_COLOR);
  glUseProgram(program_.name());
  glBindVertexArray(no_attributes_.name());
  glDrawArrays(GL_TRIANGLES, 0, 3);
  glDisable(GL_BLEND);
}

}  // namespace yuragi::viewer::gl
