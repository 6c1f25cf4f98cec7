#pragma once

#include <string>

#include "engine/look/look.hpp"
#include "viewer/pace/pace_ladder.hpp"

namespace yuragi::viewer::pace {

/// The quality to draw in: that of the look; if it leaves the choice to the viewer, low without graphics hardware and
/// high with it.
look::Quality quality_for(look::Quality wanted, bool is_software_renderer);

/// For a person: "quality low: hard shadows, on the ground only; ...". Lists what is omitted, also by the pace;
/// `refreshes`: of the display, per picture.
std::string quality_text(look::Quality quality, const DrawnPart& drawn = {}, int refreshes = 1);

}  // namespace yuragi::viewer::pace
