#pragma once

#include <cstddef>
#include <map>

#include "viewer/gl/gl.hpp"

namespace yuragi::viewer::gl {

/// Draws many strips of triangles as one mesh. If the processor draws, hairs cost a quarter less than as instances
/// (llvmpipe 22.3: 8.2 ms against 10.6).
///
/// A vertex shader finds corner `number & 255` of strip `number >> 8`, where number is first_corner + gl_VertexID, and
/// the strip's data in a TexelBuffer. Needs a current context. Allocates when a number of corners is first drawn.
class StripIndices {
 public:
  static constexpr int kCornerBits = 8;  // hair.vert.glsl and reed.vert.glsl have the same number

  /// Draws `strips` strips from the `first` on with the program in use, whose uniform `first_corner` is at this place.
  /// `corners`: of each, two for a ring; 4 to 256.
  void draw(GLint first_corner_place, std::size_t corners, std::size_t first, std::size_t strips);

 private:
  struct Mesh {
    Buffer indices;
    VertexArray array;
  };
  std::map<std::size_t, Mesh> meshes_;  // by corners
};

}  // namespace yuragi::viewer::gl
