#pragma once

#include <filesystem>
#include <span>
#include <vector>

#include "daemon/settings/opening_hours.hpp"
#include "daemon/settings/wind_config.hpp"
#include "engine/base/parameter.hpp"
#include "engine/wind/shaping/wind_shaping.hpp"

namespace yuragi::daemon::settings {

/// [shaping]: how the real wind is changed for the scenes.
struct ShapingConfig {
  wind::shaping::WindShapingSettings settings;
  OpeningHours hours;
  double norm_speed_m_s = 12.0;       ///< at which values::Quantity::kNorm is 1 while the site's winds are not known
  std::filesystem::path site_file{};  ///< keeps what was learnt of the site over a restart; empty: not kept
};

/// The keys of the table [shaping].
std::span<const Parameter> shaping_parameters();

/// Fills it from the values of shaping_parameters(); the breeze that the floor adds has the turbulence of `wind`.
/// Returns the contradictions, and invalid hours.
std::vector<ParameterError> fill_shaping(ShapingConfig& shaping, const ParameterValues& values, const WindConfig& wind);

}  // namespace yuragi::daemon::settings
