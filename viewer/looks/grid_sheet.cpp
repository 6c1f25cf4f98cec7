#include "viewer/looks/grid_sheet.hpp"

namespace yuragi::viewer::looks {

void describe_arrays(const gl::Buffer& buffer, GLuint first, GLuint count, std::size_t size) {
  glBindBuffer(GL_ARRAY_BUFFER, buffer.name());
  for (GLuint i = 0; i < count; ++i) {
    // OpenGL takes an offset in a buffer as a pointer.
    // NOLINTNEXTLINE(performance-no-int-to-ptr)
    const auto* const at = reinterpret_cast<const void*>(i * size * sizeof(float));
    glVertexAttribPointer(first + i, 1, GL_FLOAT, GL_FALSE, sizeof(float), at);
    glEnableVertexAttribArray(first + i);
  }
}

GridSheet::GridSheet(const meshes::GridLayout& layout) : layout_(layout), normals_(3 * layout.size()) {
  const std::vector<std::uint32_t> triangles = meshes::grid_triangles(layout);
  index_count_ = static_cast<GLsizei>(triangles.size());
  glBindVertexArray(array_.name());
  glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, index_buffer_.name());
  glBufferData(GL_ELEMENT_ARRAY_BUFFER, static_cast<GLsizeiptr>(triangles.size() * sizeof(std::uint32_t)),
               triangles.data(), GL_STATIC_DRAW);
  describe_arrays(point_buffer_, 0, 3, layout.size());
  describe_arrays(normal_buffer_, 3, 3, layout.size());
}

void GridSheet::move_to(std::span<const float> points) {
  meshes::grid_normals(layout_, points, normals_);
  gl::stream_to(GL_ARRAY_BUFFER, point_buffer_, points);
  gl::stream_to(GL_ARRAY_BUFFER, normal_buffer_, std::span<const float>(normals_));
}

void GridSheet::set_level(std::span<const float> levels) {
  glBindVertexArray(array_.name());
  gl::stream_to(GL_ARRAY_BUFFER, level_buffer_, levels);
  describe_arrays(level_buffer_, 6, 1, layout_.size());
}

void GridSheet::draw() const {
  glBindVertexArray(array_.name());
  glDrawElements(GL_TRIANGLES, index_count_, GL_UNSIGNED_INT, nullptr);
}

}  // namespace yuragi::viewer::looks
