#include "viewer/gl/edge_smoother.hpp"

#include "viewer/gl/shaders.hpp"

namespace yuragi::viewer::gl {

EdgeSmoother::EdgeSmoother() : program_(link_program("smooth edges", shaders::kDoorVert, shaders::kSmoothEdgesFrag)) {
  set_sampler(program_, "picture", kEdgesUnit);
}

void EdgeSmoother::draw(const RenderTarget& target) {
  target.bind_resolved();
  glActiveTexture(GL_TEXTURE0 + kEdgesUnit);
  glBindTexture(GL_TEXTURE_2D, copy_.name());
  if (width_px_ != target.width_px() || height_px_ != target.height_px()) {
    width_px_ = target.width_px();
    height_px_ = target.height_px();
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, width_px_, height_px_, 0, GL_RGBA, GL_UNSIGNED_BYTE, nullptr);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  }
  glCopyTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, 0, 0, width_px_, height_px_);
  glActiveTexture(GL_TEXTURE0);
  glDisable(GL_DEPTH_TEST);
  glDisable(GL_BLEND);
  glUseProgram(program_.name());
  glBindVertexArray(no_attributes_.name());
  glDrawArrays(GL_TRIANGLES, 0, 3);
}

}  // namespace yuragi::viewer::gl
