#include "viewer/wall/test_card.hpp"

#include "viewer/gl/shaders.hpp"

namespace yuragi::viewer::wall {

TestCard::TestCard()
    : program_(gl::link_program("test-card", gl::shaders::kDoorVert, gl::shaders::kTestCardFrag)),
      picture_px_(glGetUniformLocation(program_.name(), "picture_px")) {}

void TestCard::draw(const output::Size& size) {
  glDisable(GL_DEPTH_TEST);
  glDisable(GL_BLEND);
  glUseProgram(program_.name());
  glUniform2f(picture_px_, static_cast<float>(size.width_px), static_cast<float>(size.height_px));
  glBindVertexArray(no_attributes_.name());
  glDrawArrays(GL_TRIANGLES, 0, 3);
}

}  // namespace yuragi::viewer::wall
