#include "viewer/gl/cross_fade.hpp"

#include "viewer/gl/shaders.hpp"

namespace yuragi::viewer::gl {
namespace {

// Of their own, so that no renderer's texture is unbound.

}  // namespace

CrossFade::CrossFade() : program_(link_program("cross-fade", shaders::kDoorVert, shaders::kCrossFadeFrag)) {
  set_sampler(program_, "picture_before", kBeforeUnit);
  set_sampler(program_, "picture_now", kNowUnit);
  share_ = glGetUniformLocation(program_.name(), "share");
}

void CrossFade::take(Copy& copy, const RenderTarget& target) {
  glBindTexture(GL_TEXTURE_2D, copy.texture.name());
  if (copy.width_px != target.width_px() || copy.height_px != target.height_px()) {
    copy.width_px = target.width_px();
    copy.height_px = target.height_px();
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, copy.width_px, copy.height_px, 0, GL_RGBA, GL_UNSIGNED_BYTE, nullptr);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
  }
  target.bind_resolved();
  glCopyTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, 0, 0, copy.width_px, copy.height_px);
}

void CrossFade::keep(const RenderTarget& target) {
  glActiveTexture(GL_TEXTURE0 + kBeforeUnit);
  take(before_, target);
  glActiveTexture(GL_TEXTURE0);
}

void CrossFade::draw(const RenderTarget& target, float share) {
  glActiveTexture(GL_TEXTURE0 + kNowUnit);
  take(now_, target);
  glActiveTexture(GL_TEXTURE0 + kBeforeUnit);
  glBindTexture(GL_TEXTURE_2D, before_.texture.name());
  glActiveTexture(GL_TEXTURE0);
  glDisable(GL_DEPTH_TEST);
  glDisable(GL_BLEND);
  glUseProgram(program_.name());
  glUniform1f(share_, share);
  glBindVertexArray(no_attributes_.name());
  glDrawArrays(GL_TRIANGLES, 0, 3);
}

}  // namespace yuragi::viewer::gl
