#pragma once

#include <glm/vec2.hpp>

#include "viewer/gl/gl.hpp"
#include "viewer/meshes/solid_mesh.hpp"

namespace yuragi::viewer::looks {

/// A SolidMesh on the GPU, with its own program. Needs a current context.
class Solids {
 public:
  explicit Solids(const meshes::SolidMesh& mesh);

  /// Turns it about the vertical axis through a place (x, z), clockwise seen from above, from its original position.
  void turn(const glm::vec2& axis_m, float sine, float cosine);

  /// The View is bound (ViewBuffer::set).
  void draw() const;
  /// Draws it without its rings, which are visible only from near by.
  void draw_coarsely() const;

 private:
  GLsizei index_count_;  ///< including the rings, which are the last
  GLsizei ring_index_count_;
  gl::Program program_;
  GLint axis_place_, turn_place_;
  gl::Buffer vertex_buffer_;
  gl::Buffer index_buffer_;
  gl::VertexArray array_;
};

}  // namespace yuragi::viewer::looks
