#include "viewer/gl/render_target.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace yuragi::viewer::gl {
namespace {

int supported_samples(int wanted) {
  GLint most = 0;
  glGetIntegerv(GL_MAX_SAMPLES, &most);
  return std::clamp(wanted, 1, std::max(1, most));
}

void attach(GLenum attachment, const Renderbuffer& buffer, GLenum format, int samples, int width_px, int height_px) {
  glBindRenderbuffer(GL_RENDERBUFFER, buffer.name());
  glRenderbufferStorageMultisample(GL_RENDERBUFFER, samples > 1 ? samples : 0, format, width_px, height_px);
  glFramebufferRenderbuffer(GL_FRAMEBUFFER, attachment, GL_RENDERBUFFER, buffer.name());
}

void require_complete() {
  if (glCheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE) {
    throw std::runtime_error(
        "the graphics driver cannot render a picture of this size; try a smaller --size or --samples 1");
  }
}

}  // namespace

RenderTarget::RenderTarget(int width_px, int height_px, int samples)
    : width_px_(width_px),
      height_px_(height_px),
      samples_(supported_samples(samples)),
      drawn_width_px_(width_px),
      drawn_height_px_(height_px) {
  glBindFramebuffer(GL_FRAMEBUFFER, sampled_.name());
  attach(GL_COLOR_ATTACHMENT0, sampled_color_, GL_RGBA8, samples_, width_px, height_px);
  attach(GL_DEPTH_STENCIL_ATTACHMENT, sampled_depth_, GL_DEPTH24_STENCIL8, samples_, width_px, height_px);
  require_complete();
  glBindFramebuffer(GL_FRAMEBUFFER, resolved_.name());
  attach(GL_COLOR_ATTACHMENT0, resolved_color_, GL_RGBA8, 1, width_px, height_px);
  require_complete();
}

void RenderTarget::set_drawn_side(float part) {
  if (samples_ > 1) return;
  const auto part_of = [part](int size_px) {
    return std::clamp(static_cast<int>(std::lround(part * static_cast<float>(size_px))), 1, size_px);
  };
  drawn_width_px_ = part_of(width_px_);
  drawn_height_px_ = part_of(height_px_);
}

void RenderTarget::begin() {
  glBindFramebuffer(GL_FRAMEBUFFER, sampled_.name());
  glViewport(0, 0, drawn_width_px_, drawn_height_px_);
}

void RenderTarget::resolve() {
  glBindFramebuffer(GL_READ_FRAMEBUFFER, sampled_.name());
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, resolved_.name());
  const bool is_whole = drawn_width_px_ == width_px_ && drawn_height_px_ == height_px_;
  glBlitFramebuffer(0, 0, drawn_width_px_, drawn_height_px_, 0, 0, width_px_, height_px_, GL_COLOR_BUFFER_BIT,
                    is_whole ? GL_NEAREST : GL_LINEAR);
  bind_resolved();
}

void RenderTarget::bind_resolved() const {
  glBindFramebuffer(GL_FRAMEBUFFER, resolved_.name());
  glViewport(0, 0, width_px_, height_px_);
}

void RenderTarget::show(int window_width_px, int window_height_px) {
  glBindFramebuffer(GL_READ_FRAMEBUFFER, resolved_.name());
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, 0);
  glBlitFramebuffer(0, 0, width_px_, height_px_, 0, 0, window_width_px, window_height_px, GL_COLOR_BUFFER_BIT,
                    GL_NEAREST);
}

std::vector<std::uint8_t> RenderTarget::read_rgb() {
  const auto columns = static_cast<std::size_t>(width_px_);
  const auto rows = static_cast<std::size_t>(height_px_);
  std::vector<std::uint8_t> rgba(4 * columns * rows);  // OpenGL ES gives no fewer numbers a pixel
  glBindFramebuffer(GL_READ_FRAMEBUFFER, resolved_.name());
  glReadPixels(0, 0, width_px_, height_px_, GL_RGBA, GL_UNSIGNED_BYTE, rgba.data());

  // OpenGL's first row is the lowest.
  std::vector<std::uint8_t> picture(3 * columns * rows);
  std::uint8_t* to = picture.data();
  for (std::size_t row = rows; row-- > 0;) {
    const std::uint8_t* from = &rgba[4 * columns * row];
    for (std::size_t column = 0; column < columns; ++column, from += 4, to += 3) std::copy_n(from, 3, to);
  }
  return picture;
}

}  // namespace yuragi::viewer::gl
