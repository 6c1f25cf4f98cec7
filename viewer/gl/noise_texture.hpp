#pragma once

#include "viewer/gl/gl.hpp"

namespace yuragi::viewer::gl {

/// A small tile of soft noise that repeats without a seam, one byte a texel, with mipmaps: for clouds, turf and patches
/// of colour. It is for drawing alone; the wind's noise is the engine's (engine/noise).
GlTexture make_noise_texture();

}  // namespace yuragi::viewer::gl
