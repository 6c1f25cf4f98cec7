#include "daemon/settings/wind_config.hpp"

#include <algorithm>
#include <utility>

#include "daemon/settings/site_octaves.hpp"
#include "engine/wind/blend/blend_settings.hpp"

namespace yuragi::daemon::settings {

double WindConfig::gust_length_m() const noexcept {
  return default_length_m.value_or(wind::blend::BlendSettings{}.length_m);
}

Result<WindConfig, ParameterError> wind_config_of(const ParameterValues& values) {
  auto octaves_db = parse_site_octaves(values.text("site_octaves"));
  if (!octaves_db) return ParameterError{"site_octaves", octaves_db.error().message};
  WindConfig wind{.default_speed_m_s = values.number("default_speed"),
                  .default_direction_deg = values.number("default_direction"),
                  .default_turbulence_intensity = values.number("default_turbulence"),
                  .default_length_m = std::nullopt,
                  .gustiness = values.number("gustiness"),
                  .site_octaves_db = std::move(*octaves_db),
                  .is_evolving = values.flag("evolving"),
                  .handover_s = values.number("handover"),
                  .stale_intervals = values.number("stale_intervals"),
                  .return_after_s = values.number("return_after"),
                  .has_relative_gains = values.flag("relative_gains")};
  if (const double length_m = values.number("default_length"); length_m > 0.0) {
    wind.default_length_m = std::max(length_m, kShortestGusts_m);
  }
  if (const std::string& recording = values.text("fallback_recording"); !recording.empty()) {
    wind.fallback = {.recording = recording, .after_s = values.number("fallback_after")};
  }
  return wind;
}

}  // namespace yuragi::daemon::settings
