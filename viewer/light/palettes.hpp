#pragma once

#include "engine/look/look.hpp"
#include "viewer/light/light.hpp"

namespace yuragi::viewer::light {

/// Puts the colors of plants and ground into `light`, and the size of the image on the ground.
void set_colors(const look::Look& look, Light& light);

}  // namespace yuragi::viewer::light
