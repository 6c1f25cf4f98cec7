#include "viewer/looks/image_texture.hpp"

#include <algorithm>
#include <cstdint>
#include <vector>

namespace yuragi::viewer::looks {
namespace {

/// Samples along the longer side of a pixel's footprint: horizontal surfaces are sharp also at flat angles.
constexpr float kMaxAnisotropy = 8.0F;

}  // namespace

gl::Texture image_texture(const look::Image& image, GLint wrap) {
  gl::Texture texture;
  glActiveTexture(GL_TEXTURE0);
  glBindTexture(GL_TEXTURE_2D, texture.name());
  // With an alpha: OpenGL ES makes smaller images only of formats that it can draw into.
  std::vector<std::uint8_t> rgba;
  rgba.reserve(image.rgb.size() / 3 * 4);
  for (std::size_t i = 0; i + 3 <= image.rgb.size(); i += 3) {
    rgba.insert(rgba.end(), {image.rgb[i], image.rgb[i + 1], image.rgb[i + 2], 255});
  }
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  glTexImage2D(GL_TEXTURE_2D, 0, GL_SRGB8_ALPHA8, static_cast<GLsizei>(image.width_px),
               static_cast<GLsizei>(image.height_px), 0, GL_RGBA, GL_UNSIGNED_BYTE, rgba.data());
  glGenerateMipmap(GL_TEXTURE_2D);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, wrap);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, wrap);
  if (wrap == GL_REPEAT && epoxy_has_gl_extension("GL_EXT_texture_filter_anisotropic")) {
    float most = 1.0F;
    glGetFloatv(GL_MAX_TEXTURE_MAX_ANISOTROPY_EXT, &most);
    glTexParameterf(GL_TEXTURE_2D, GL_TEXTURE_MAX_ANISOTROPY_EXT, std::min(most, kMaxAnisotropy));
  }
  return texture;
}

}  // namespace yuragi::viewer::looks
