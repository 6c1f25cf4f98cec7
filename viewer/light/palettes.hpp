#pragma once

#include "engine/look/look.hpp"
#include "viewer/light/light.hpp"

namespace yuragi::viewer::light {

/// Puts the colors of what grows, and of the ground, into `light`, and the size of the picture on it.
void set_colors(const look::Look& look, Light& light);

}  // namespace yuragi::viewer::light
