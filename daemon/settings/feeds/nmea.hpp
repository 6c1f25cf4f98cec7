#pragma once

#include <span>
#include <string>

#include "daemon/settings/feeds/span.hpp"
#include "daemon/values/moment.hpp"
#include "engine/base/parameter.hpp"
#include "engine/base/result.hpp"

namespace yuragi::daemon::settings::feeds {

/// An [[nmea]]: the wind as sentences of NMEA 0183.
struct Nmea {
  std::string name = {};
  std::string to = {};      ///< HOST:PORT by UDP; empty: not
  std::string listen = {};  ///< HOST:PORT for clients by TCP; empty: not
  double rate_hz = 1.0;
  values::Wind wind = values::Wind::kShaped;
  friend bool operator==(const Nmea&, const Nmea&) = default;
};

std::span<const Parameter> nmea_parameters();

/// From values of these parameters. An error names the key.
Result<Nmea, ParameterError> nmea_of(std::string name, const ParameterValues& values);

}  // namespace yuragi::daemon::settings::feeds
