#pragma once

#include "viewer/gl/gl.hpp"

namespace yuragi {

/// A small tile of soft noise that repeats without a seam, one byte a texel, with mipmaps: for clouds, turf and patches
/// of colour. (The wind's noise is the engine's; this one only has to look natural.)
GlTexture make_noise_texture();

}  // namespace yuragi
