#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "drivers/sensor/stated_value.hpp"
#include "engine/base/parameter.hpp"

namespace yuragi::daemon::settings {

/// [wind] fallback: a recording that is played while every sensor is silent.
struct FallbackConfig {
  std::filesystem::path recording;
  double after_s = 0.0;  ///< for how long every sensor must have been silent
  std::string origin{};  ///< `file:line:column` of its key; empty: it is in no file
  /// The recorded sensor sent only changes (RecordedSource); 0: it did not, or this is not yet known.
  double unchanged_for_s = 0.0;
  drivers::sensor::StatedValue value{};  ///< what the recorded speeds are (RecordedSource)
};

/// [wind] lead and follow: one wind for several daemons, by way of a NATS server.
struct LeadConfig {
  std::vector<std::string> lead, follow;  ///< servers, "nats://HOST:PORT" or "tls://HOST:PORT"; empty: not
  double delay_s = 0.0;                   ///< from the making of a tick to its playing
  std::string channel = {};               ///< how the leader's subjects begin
  std::string credentials = {};           ///< a file; empty: none
  std::string node = {};                  ///< what this daemon is called among all; empty: the machine's name
  std::string authorities = {};           ///< a file of certificates, PEM; empty: the system's

  /// Returns true if its ticks have numbers, which other daemons know.
  bool is_in_company() const noexcept { return !lead.empty() || !follow.empty(); }
};

/// The least integral length that is assumed.
inline constexpr double kMinGusts_m = 1.0;

/// [wind]: the wind while no sensor is live, and the hand-over between sources.
struct WindConfig {
  double default_speed_m_s = 0.0;
  double default_direction_deg = 0.0;  ///< where it comes from, clockwise from north; also for sensors without a vane
  double default_turbulence_intensity = 0.0;  ///< standard deviation over mean speed
  std::optional<double> default_length_m;     ///< integral length of all gusts, at least 1; none: from the heights
  double gustiness = 0.0;                     ///< blend::Settings::gustiness
  std::vector<double> site_octaves_db{};      ///< SiteSpectrum::expect(); empty: no expectation
  bool is_evolving = true;                    ///< gusts change while they travel; false: frozen turbulence
  double handover_s = 0.0;                    ///< blend::Settings::handover_s
  double stale_intervals = 0.0;               ///< blend::Settings::stale_intervals
  double return_after_s = 0.0;                ///< blend::Settings::return_after_s
  bool has_relative_gains = true;             ///< sensors that are compared are levelled (GroupGains)
  std::optional<FallbackConfig> fallback{};   ///< none: the default wind while every sensor is silent
  LeadConfig lead{};

  /// Integral length of the default wind's gusts, m: default_length_m, or 57, as over open land at a height of 10 m.
  double gust_length_m() const noexcept;
};

/// The keys of [wind].
std::span<const Parameter> wind_parameters();

/// Fills it from the values of wind_parameters(). Returns the contradictions.
std::vector<ParameterError> fill_wind(WindConfig& wind, const ParameterValues& values);

}  // namespace yuragi::daemon::settings
