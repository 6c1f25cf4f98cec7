#include "viewer/gl/cross_fade.hpp"

#include "viewer/gl/shaders.hpp"

namespace yuragi::viewer::gl {

CrossFade::CrossFade() : program_(link_program("cross-fade", shaders::kDoorVert, shaders::kCrossFadeFrag)) {
  set_sampler(program_, "picture_before", kBeforeUnit);
  set_sampler(program_, "picture_now", kNowUnit);
  share_ = glGetUniformLocation(program_.name(), "share");
}

void CrossFade::keep(const RenderTarget& target) {
  glActiveTexture(GL_TEXTURE0 + kBeforeUnit);
  before_.take(target);
  glActiveTexture(GL_TEXTURE0);
}

void CrossFade::draw(const RenderTarget& target, float share) {
  glActiveTexture(GL_TEXTURE0 + kNowUnit);
  now_.take(target);
  glActiveTexture(GL_TEXTURE0 + kBeforeUnit);
  glBindTexture(GL_TEXTURE_2D, before_.texture());
  glActiveTexture(GL_TEXTURE0);
  glDisable(GL_DEPTH_TEST);
  glDisable(GL_BLEND);
  glUseProgram(program_.name());
  glUniform1f(share_, share);
  glBindVertexArray(no_attributes_.name());
  glDrawArrays(GL_TRIANGLES, 0, 3);
}

}  // namespace yuragi::viewer::gl
