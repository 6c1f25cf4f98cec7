#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "viewer/gl/gl.hpp"

namespace yuragi::viewer::gl {

/// An array of numbers that shaders read by index: `fetch()` of shaders/picture/common.glsl. WebGL 2 has no buffer
/// textures, so it is a texture of two dimensions, kWide texels wide, row behind row. Needs a current context. Uploads
/// and binding use texture unit 0, or the one that bind() names, and leave it active.
///
/// Each begin() takes the next of kCopies textures, because the graphics hardware may still read the one before. A
/// texture grows when more is written than it has room for; it never shrinks.
class TexelBuffer {
 public:
  static constexpr std::size_t kWide = 1024;  ///< common.glsl has the same number

  /// `format`: of a texel: GL_R32F, GL_RG32F, GL_RGBA32F or GL_R32UI.
  explicit TexelBuffer(GLenum format);

  /// Begins new content of this many texels, which are undefined until they are written. What is more than a texture of
  /// this driver can hold is left out.
  void begin(std::size_t texels);
  /// Writes whole texels, from this one on. What is beyond the number that begin() got is left out.
  template <class T>
  void write(std::size_t first, std::span<const T> content) {
    write(first, reinterpret_cast<const std::byte*>(content.data()), content.size_bytes());
  }
  /// Both, for content of one piece.
  template <class T>
  void fill(std::span<const T> content) {
    begin(content.size_bytes() / texel_bytes_);
    write(0, content);
  }

  /// Makes it the texture of this unit, and that unit the active one.
  void bind(GLint unit) const;

 private:
  static constexpr std::size_t kCopies = 3;

  struct Copy {
    Texture texture;
    std::size_t rows = 0;
  };

  void write(std::size_t first, const std::byte* content, std::size_t bytes);
  void write_rectangle(std::size_t first, std::size_t columns, std::size_t rows, const std::byte* content) const;

  GLenum format_, order_, type_;
  std::size_t texel_bytes_;
  std::size_t most_rows_;
  std::size_t texels_ = 0;  // of the content
  std::array<Copy, kCopies> copies_;
  std::size_t latest_ = 0;
};

}  // namespace yuragi::viewer::gl
