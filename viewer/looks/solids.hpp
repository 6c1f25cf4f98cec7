#pragma once

#include <glm/vec2.hpp>

#include "viewer/gl/gl.hpp"
#include "viewer/meshes/solid_mesh.hpp"

namespace yuragi {

/// A SolidMesh on the GPU, with its own program. Needs a current context.
class Solids {
 public:
  explicit Solids(const SolidMesh& mesh);

  /// Turns it about the vertical through a place (x, z), clockwise seen from above, from the position in which it was
  /// made.
  void turn(const glm::vec2& axis_m, float sine, float cosine);

  /// The View is bound (ViewBuffer::set).
  void draw() const;

 private:
  GLsizei index_count_;
  GlProgram program_;
  GLint axis_place_, turn_place_;
  GlBuffer vertex_buffer_;
  GlBuffer index_buffer_;
  GlVertexArray array_;
};

}  // namespace yuragi
