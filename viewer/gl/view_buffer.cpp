#include "viewer/gl/view_buffer.hpp"

#include <span>

namespace yuragi::viewer::gl {

void ViewBuffer::set(const meshes::View& view) {
  stream_to(GL_UNIFORM_BUFFER, buffer_, std::span(&view, 1));
  glBindBufferBase(GL_UNIFORM_BUFFER, kViewBinding, buffer_.name());
}

}  // namespace yuragi::viewer::gl
