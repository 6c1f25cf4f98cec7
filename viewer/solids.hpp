#pragma once

#include "viewer/gl.hpp"
#include "viewer/solid_mesh.hpp"

namespace yuragi {

/// A SolidMesh on the GPU, lit as everything else. Needs a current context.
class Solids {
 public:
  explicit Solids(const SolidMesh& mesh);

  /// The View is bound (ViewBuffer::set).
  void draw() const;

 private:
  GLsizei index_count_;
  GlProgram program_;
  GlBuffer vertex_buffer_;
  GlBuffer index_buffer_;
  GlVertexArray array_;
};

}  // namespace yuragi
