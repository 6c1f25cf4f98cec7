#pragma once

#include <cstddef>
#include <map>

#include "viewer/gl/gl.hpp"

namespace yuragi::viewer::gl {

/// Draws many strips of triangles as one mesh. If the processor draws, hairs cost a quarter less than as instances
/// (llvmpipe 22.3: 8.2 ms against 10.6).
///
/// A vertex shader finds corner gl_VertexID & 255 of strip gl_VertexID >> 8, and the strip's data in a texture buffer.
/// Needs a current context. Allocates when a number of corners is first drawn.
class StripIndices {
 public:
  static constexpr int kCornerBits = 8;  // hair.vert.glsl and reed.vert.glsl have the same number

  /// Draws strips 0 to `strips` - 1 with the program in use. `corners`: of each, two for a ring; 4 to 256.
  void draw(std::size_t corners, std::size_t strips);

 private:
  struct Mesh {
    Buffer indices;
    VertexArray array;
  };
  std::map<std::size_t, Mesh> meshes_;  // by corners
};

}  // namespace yuragi::viewer::gl
