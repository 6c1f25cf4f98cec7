#pragma once

#include <filesystem>
#include <vector>

#include "daemon/settings/opening_hours.hpp"
#include "daemon/settings/wind_config.hpp"
#include "engine/base/parameter.hpp"
#include "engine/base/result.hpp"
#include "engine/wind/shaping/wind_shaping.hpp"

namespace yuragi {

/// [shaping]: between the real wind and the scenes'.
struct ShapingConfig {
  WindShapingSettings settings;
  OpeningHours hours;
  std::filesystem::path site_file{};  ///< where the memory of the site is kept over a restart; empty: nowhere
};

/// Of the values of shaping_parameters(); the breeze that the floor adds has the turbulence of `wind`. The errors, what
/// does not fit together and hours that are none, each name the key that they are about.
Result<ShapingConfig, std::vector<ParameterError>> shaping_config_of(const ParameterValues& values,
                                                                     const WindConfig& wind);

}  // namespace yuragi
