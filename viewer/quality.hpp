#pragma once

#include <string>

#include "engine/look/look.hpp"
#include "viewer/pace_keeper.hpp"

namespace yuragi::viewer {

/// The quality to draw in: that of the look, or, where it leaves it to the viewer, low without graphics hardware and
/// high with it.
look::Quality quality_for(look::Quality wanted, bool is_software_renderer);

/// For a person: "quality low: hard shadows, on the ground only; ...". Says what is left out, for the pace besides.
std::string quality_text(look::Quality quality, const DrawnPart& drawn = {});

}  // namespace yuragi::viewer
