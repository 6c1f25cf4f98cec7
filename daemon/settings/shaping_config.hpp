#pragma once

#include <filesystem>
#include <span>
#include <vector>

#include "daemon/settings/opening_hours.hpp"
#include "daemon/settings/wind_config.hpp"
#include "engine/base/parameter.hpp"
#include "engine/base/result.hpp"
#include "engine/wind/shaping/wind_shaping.hpp"

namespace yuragi::daemon::settings {

/// [shaping]: how the real wind is changed for the scenes.
struct ShapingConfig {
  wind::shaping::WindShapingSettings settings;
  OpeningHours hours;
  std::filesystem::path site_file{};  ///< keeps what was learnt of the site over a restart; empty: not kept
};

/// What the table [shaping] may hold.
std::span<const Parameter> shaping_parameters();

/// From the values of shaping_parameters(); the breeze that the floor adds has the turbulence of `wind`. Each error
/// (values that contradict each other, invalid hours) names its key.
Result<ShapingConfig, std::vector<ParameterError>> shaping_config_of(const ParameterValues& values,
                                                                     const WindConfig& wind);

}  // namespace yuragi::daemon::settings
