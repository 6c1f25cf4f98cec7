#pragma once

#include "engine/look/cloth_look.hpp"
#include "viewer/gl/gl.hpp"

namespace yuragi::viewer::looks {

/// A picture as a texture of light (sRGB), with smaller ones for the distance. `wrap`: GL_CLAMP_TO_EDGE or GL_REPEAT.
/// Binds texture unit 0. Needs a current context.
gl::Texture image_texture(const look::Image& image, GLint wrap);

}  // namespace yuragi::viewer::looks
