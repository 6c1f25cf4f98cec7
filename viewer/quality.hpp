#pragma once

#include <string>

#include "engine/look/look.hpp"

namespace yuragi::viewer {

/// The quality to draw in: that of the look, or, where it leaves it to the viewer, low without graphics hardware and
/// high with it.
look::Quality quality_for(look::Quality wanted, bool is_software_renderer);

/// For a person: "quality low: hard shadows, on the ground only; ...". Says what is left out. `drawn_side`: the part of
/// the picture's width and height that is drawn (DrawnPart).
std::string quality_text(look::Quality quality, float drawn_side = 1.0F);

}  // namespace yuragi::viewer
