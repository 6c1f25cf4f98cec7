#include "viewer/gl/picture_copy.hpp"

namespace yuragi::viewer::gl {

void PictureCopy::take(const RenderTarget& target) {
  glBindTexture(GL_TEXTURE_2D, texture_.name());
  if (width_px_ != target.width_px() || height_px_ != target.height_px()) {
    width_px_ = target.width_px();
    height_px_ = target.height_px();
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, width_px_, height_px_, 0, GL_RGBA, GL_UNSIGNED_BYTE, nullptr);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, filter_);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, filter_);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  }
  target.bind_resolved();
  glCopyTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, 0, 0, width_px_, height_px_);
}

}  // namespace yuragi::viewer::gl
