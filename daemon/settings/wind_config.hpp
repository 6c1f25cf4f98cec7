#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "engine/base/parameter.hpp"
#include "engine/base/result.hpp"

namespace yuragi {

/// A recording that is played while every sensor is silent.
struct FallbackConfig {
  std::filesystem::path recording;
  double after_s = 0.0;  ///< how long every sensor must have been silent for that
  std::string origin{};  ///< `file:line:column` of its key; empty where no file says it
};

/// No gusts are taken for shorter than this.
inline constexpr double kShortestGusts_m = 1.0;

/// [wind]: the wind that blows while no sensor speaks, and the way from one source of wind to another.
struct WindConfig {
  double default_speed_m_s = 0.0;
  double default_direction_deg = 0.0;  ///< where it comes from, clockwise from north; of sensors without a vane, too
  double default_turbulence_intensity = 0.0;  ///< standard deviation over mean speed
  std::optional<double> default_length_m;     ///< integral length scale of all gusts, at least 1; none: by heights
  double gustiness = 0.0;                     ///< BlendSettings::gustiness
  std::vector<double> site_octaves_db{};      ///< SiteSpectrum::expect(); empty: nothing is expected of the site
  bool is_evolving = true;                    ///< gusts change while they travel; false: frozen turbulence
  double handover_s = 0.0;                    ///< BlendSettings::handover_s
  double stale_intervals = 0.0;               ///< BlendSettings::stale_intervals
  double return_after_s = 0.0;                ///< BlendSettings::return_after_s
  std::optional<FallbackConfig> fallback{};   ///< none: the default wind blows while every sensor is silent

  /// How far the gusts of the default wind reach, m: default_length_m, or 57, as over open land at a height of 10 m.
  double gust_length_m() const noexcept;
};

/// Of the values of wind_parameters(). The error names the key that it is about.
Result<WindConfig, ParameterError> wind_config_of(const ParameterValues& values);

}  // namespace yuragi
