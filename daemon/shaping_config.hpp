#pragma once

#include <span>
#include <vector>

#include "daemon/config.hpp"
#include "daemon/opening_hours.hpp"
#include "engine/wind/wind_shaping.hpp"

namespace yuragi {

/// What the table [shaping] may hold.
std::span<const Parameter> shaping_parameters();

/// What does not fit together in it, and hours that are none: each with the key that it is about.
std::vector<ParameterError> shaping_mistakes(const ParameterValues& shaping);

/// What it says, with the turbulence of [wind] for the breeze. Of a configuration without mistakes.
WindShapingSettings shaping_settings(const Config& config);
OpeningHours opening_hours(const Config& config);

}  // namespace yuragi
