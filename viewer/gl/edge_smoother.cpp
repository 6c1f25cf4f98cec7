#include "viewer/gl/edge_smoother.hpp"

#include "viewer/gl/shaders.hpp"

namespace yuragi::viewer::gl {

EdgeSmoother::EdgeSmoother() : program_(link_program("smooth edges", shaders::kDoorVert, shaders::kSmoothEdgesFrag)) {
  set_sampler(program_, "picture", kEdgesUnit);
}

void EdgeSmoother::draw(const RenderTarget& target) {
  glActiveTexture(GL_TEXTURE0 + kEdgesUnit);
  copy_.take(target);
  glActiveTexture(GL_TEXTURE0);
  glDisable(GL_DEPTH_TEST);
  glDisable(GL_BLEND);
  glUseProgram(program_.name());
  glBindVertexArray(no_attributes_.name());
  glDrawArrays(GL_TRIANGLES, 0, 3);
}

}  // namespace yuragi::viewer::gl
