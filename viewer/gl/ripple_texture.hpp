#pragma once

#include "viewer/gl/gl.hpp"

namespace yuragi::viewer::gl {

/// Slopes of small ripples, to be laid tile beside tile: two numbers a texel from 0 to 1, 0.5 being level, with a
/// standard deviation of kRippleDeviation each, and coarser levels. Always the same.
inline constexpr float kRippleDeviation = 0.16F;
Texture make_ripple_texture();

}  // namespace yuragi::viewer::gl
