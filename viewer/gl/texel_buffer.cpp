#include "viewer/gl/texel_buffer.hpp"

#include <algorithm>
#include <stdexcept>

namespace yuragi::viewer::gl {
namespace {

struct Layout {
  GLenum order = 0;
  GLenum type = 0;
  std::size_t bytes = 0;
};

Layout layout_of(GLenum format) {
  switch (format) {
    case GL_R32F:
      return {GL_RED, GL_FLOAT, 4};
    case GL_RG32F:
      return {GL_RG, GL_FLOAT, 8};
    case GL_RGBA32F:
      return {GL_RGBA, GL_FLOAT, 16};
    case GL_R32UI:
      return {GL_RED_INTEGER, GL_UNSIGNED_INT, 4};
    default:
      throw std::logic_error("a TexelBuffer has no such format");
  }
}

std::size_t largest_side() {
  GLint texels = 0;
  glGetIntegerv(GL_MAX_TEXTURE_SIZE, &texels);
  return static_cast<std::size_t>(std::max(texels, 1));
}

}  // namespace

TexelBuffer::TexelBuffer(GLenum format)
    : format_(format),
      order_(layout_of(format).order),
      type_(layout_of(format).type),
      texel_bytes_(layout_of(format).bytes),
      most_rows_(largest_side()) {
  glActiveTexture(GL_TEXTURE0);
  for (const Copy& copy : copies_) {
    glBindTexture(GL_TEXTURE_2D, copy.texture.name());
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
  }
  begin(0);
}

void TexelBuffer::begin(std::size_t texels) {
  latest_ = (latest_ + 1) % kCopies;
  texels_ = std::min(texels, kWide * most_rows_);
  Copy& copy = copies_.at(latest_);
  const std::size_t rows = std::max<std::size_t>((texels_ + kWide - 1) / kWide, 1);
  if (rows <= copy.rows) return;
  copy.rows = rows;
  bind(0);
  glTexImage2D(GL_TEXTURE_2D, 0, static_cast<GLint>(format_), static_cast<GLsizei>(kWide), static_cast<GLsizei>(rows),
               0, order_, type_, nullptr);
}

void TexelBuffer::write(std::size_t first, const std::byte* content, std::size_t bytes) {
  if (first >= texels_) return;
  std::size_t left = std::min(bytes / texel_bytes_, texels_ - first);
  bind(0);
  glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
  count_upload(left * texel_bytes_);
  // The rest of a row, whole rows, and the beginning of one.
  while (left > 0) {
    const std::size_t to_end = kWide - first % kWide;
    const bool is_whole = to_end == kWide && left >= kWide;
    const std::size_t columns = is_whole ? kWide : std::min(to_end, left);
    const std::size_t rows = is_whole ? left / kWide : 1;
    write_rectangle(first, columns, rows, content);
    first += columns * rows;
    left -= columns * rows;
    content += columns * rows * texel_bytes_;
  }
}

void TexelBuffer::write_rectangle(std::size_t first, std::size_t columns, std::size_t rows,
                                  const std::byte* content) const {
  glTexSubImage2D(GL_TEXTURE_2D, 0, static_cast<GLint>(first % kWide), static_cast<GLint>(first / kWide),
                  static_cast<GLsizei>(columns), static_cast<GLsizei>(rows), order_, type_, content);
}

void TexelBuffer::bind(GLint unit) const {
  glActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(unit));
  glBindTexture(GL_TEXTURE_2D, copies_.at(latest_).texture.name());
}

}  // namespace yuragi::viewer::gl
