#pragma once

#include "viewer/gl/gl.hpp"

namespace yuragi::viewer::gl {

/// A small tile of soft noise that repeats without a seam, one byte a texel, with mipmaps: for clouds, turf and patches
/// of colour. It is for drawing alone; the wind's noise is the engine's (engine/noise).
Texture make_noise_texture();

/// The same noise for plants: red as it is, green eight times as fine, blue only its fine part, so that the tile is not
/// seen; mid-range means none.
Texture make_turf_texture();

/// The same noise with its slopes, for lighting: red as it is; green and blue its increase over 0.035 of the tile's
/// sides; mid-range means none.
Texture make_relief_texture();

}  // namespace yuragi::viewer::gl
