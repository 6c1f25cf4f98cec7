#pragma once

#include <string>

#include "engine/look/look.hpp"
#include "viewer/pace/pace_ladder.hpp"

namespace yuragi::viewer::pace {

/// The quality to draw in: that of the look, or, where it leaves it to the viewer, low without graphics hardware and
/// high with it.
look::Quality quality_for(look::Quality wanted, bool is_software_renderer);

/// For a person: "quality low: hard shadows, on the ground only; ...". Says what is left out, for the pace besides;
/// `refreshes` of the display are for each picture.
std::string quality_text(look::Quality quality, const DrawnPart& drawn = {}, int refreshes = 1);

}  // namespace yuragi::viewer::pace
