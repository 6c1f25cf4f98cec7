#pragma once

#include <vector>

#include "viewer/gl/gl.hpp"
#include "viewer/meshes/grid_mesh.hpp"

namespace yuragi::viewer::looks {

/// For the vertex array that is bound: `buffer` holds one array of `size` numbers for each attribute from `first` on.
void describe_arrays(const gl::Buffer& buffer, GLuint first, GLuint count, std::size_t size);

/// The triangles of a surface on the GPU, with smooth normals. Needs a current context.
///
/// Attributes: the point 0 to 2 (x, y, z, metres), its normal 3 to 5. Allocates nothing after it is made.
class GridSheet {
 public:
  explicit GridSheet(const meshes::GridLayout& layout);

  /// Takes the points' present positions: all x, then all y, then all z.
  void move_to(std::span<const float> points);

  std::size_t shells() const { return layout_.shells; }

  /// Draws all triangles with the program in use.
  void draw() const;

  /// One more number for each point: attribute 6.
  void set_level(std::span<const float> levels);

 private:
  meshes::GridLayout layout_;
  std::vector<float> normals_;
  GLsizei index_count_ = 0;
  gl::Buffer index_buffer_;
  gl::Buffer point_buffer_;
  gl::Buffer normal_buffer_;
  gl::Buffer level_buffer_;
  gl::VertexArray array_;
};

}  // namespace yuragi::viewer::looks
