#pragma once

#include "engine/look/look.hpp"
#include "viewer/light/light.hpp"

namespace yuragi::viewer::light {

/// Puts the colors of what grows, and of the ground, into `light`.
void set_colors(const look::Look& look, Light& light);

}  // namespace yuragi::viewer::light
