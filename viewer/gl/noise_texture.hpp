#pragma once

#include "viewer/gl/gl.hpp"

namespace yuragi::viewer::gl {

/// A small tile of soft noise that repeats without a seam, one byte a texel, with mipmaps: for clouds, turf and patches
/// of colour. It is for drawing alone; the wind's noise is the engine's (engine/noise).
Texture make_noise_texture();

/// The same noise for what grows: red as it is, green eight times as fine, blue only what is fine of it, so that its
/// tile is not seen; half of the range for none.
Texture make_turf_texture();

/// The same noise with its slopes, for what is to be lit: red as it is; green and blue how much more it is by a part of
/// 0.035 farther along the tile's sides, half of the range for none.
Texture make_relief_texture();

}  // namespace yuragi::viewer::gl
