#pragma once

#include "daemon/settings/config.hpp"
#include "daemon/settings/opening_hours.hpp"
#include "engine/wind/shaping/wind_shaping.hpp"

namespace yuragi {

/// What the table [shaping] says, with the turbulence of [wind] for the breeze. Of a configuration without mistakes.
WindShapingSettings shaping_settings(const Config& config);
OpeningHours opening_hours(const Config& config);

}  // namespace yuragi
