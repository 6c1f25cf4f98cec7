#include "viewer/gl/view_buffer.hpp"

#include <span>

namespace yuragi::viewer::gl {

void ViewBuffer::set(const meshes::View& view) {
  stream_to(GL_UNIFORM_BUFFER, view_, std::span(&view, 1));
  glBindBufferBase(GL_UNIFORM_BUFFER, kViewBinding, view_.name());
}

void ViewBuffer::set(const light::Light& light) {
  stream_to(GL_UNIFORM_BUFFER, light_, std::span(&light, 1));
  glBindBufferBase(GL_UNIFORM_BUFFER, kLightBinding, light_.name());
}

void ViewBuffer::set(const light::Fires& fires) {
  stream_to(GL_UNIFORM_BUFFER, fires_, std::span(&fires, 1));
  glBindBufferBase(GL_UNIFORM_BUFFER, kFiresBinding, fires_.name());
}

}  // namespace yuragi::viewer::gl
