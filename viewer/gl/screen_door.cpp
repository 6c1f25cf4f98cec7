#include "viewer/gl/screen_door.hpp"

#include "viewer/gl/shaders.hpp"

namespace yuragi::viewer::gl {

ScreenDoor::ScreenDoor() : program_(link_program("door", shaders::kDoorVert, shaders::kDoorFrag)) {
  opacity_place_ = glGetUniformLocation(program_.name(), "opacity");
  number_place_ = glGetUniformLocation(program_.name(), "number");
}

void ScreenDoor::open(float opacity, std::size_t number) {
  glEnable(GL_STENCIL_TEST);
  is_half_open_ = opacity < 1.0F;
  if (is_half_open_) {
    // Marks the pixels that are left out.
    glStencilMask(kBehindDoor);
    glStencilFunc(GL_ALWAYS, kBehindDoor, kBehindDoor);
    glStencilOp(GL_KEEP, GL_KEEP, GL_REPLACE);
    glColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
    glDepthMask(GL_FALSE);
    glDisable(GL_DEPTH_TEST);
    glUseProgram(program_.name());
    glUniform1f(opacity_place_, opacity);
    glUniform1f(number_place_, static_cast<float>(number));
    glBindVertexArray(no_attributes_.name());
    glDrawArrays(GL_TRIANGLES, 0, 3);
    glEnable(GL_DEPTH_TEST);
    glDepthMask(GL_TRUE);
    glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  }
  draw_on_open();
}

void ScreenDoor::begin_mark(GLuint bit) {
  glEnable(GL_STENCIL_TEST);
  glStencilMask(bit);
  glStencilFunc(GL_EQUAL, static_cast<GLint>(bit), kBehindDoor);
  glStencilOp(GL_KEEP, GL_KEEP, GL_REPLACE);
  glColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
  glDepthMask(GL_FALSE);
  glDisable(GL_DEPTH_TEST);
}

void ScreenDoor::end_mark() {
  glEnable(GL_DEPTH_TEST);
  glDepthMask(GL_TRUE);
  glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  draw_on_open();
}

void ScreenDoor::draw_on_open() {
  if (!is_half_open_) {
    glDisable(GL_STENCIL_TEST);
    return;
  }
  glStencilMask(0);
  glStencilFunc(GL_EQUAL, 0, kBehindDoor);
  glStencilOp(GL_KEEP, GL_KEEP, GL_KEEP);
}

void ScreenDoor::close() {
  glStencilMask(kBehindDoor);
  if (is_half_open_) glClear(GL_STENCIL_BUFFER_BIT);
  glStencilMask(0xFF);
  glDisable(GL_STENCIL_TEST);
}

}  // namespace yuragi::viewer::gl
