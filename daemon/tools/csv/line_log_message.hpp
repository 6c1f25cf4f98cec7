#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "drivers/decode/decoded_wind.hpp"
#include "drivers/decode/refusal.hpp"
#include "engine/base/result.hpp"
#include "engine/wind/station_quantities.hpp"

namespace yuragi::daemon::tools::csv {

/// An anemometer's message in a line of a log.
struct LineLogMessage {
  std::string_view prefix;  ///< what the logger wrote before it
  std::string source;       ///< "MWV R of WI", "Gill of Q", "keys"; empty if the message is refused
  Result<drivers::decode::DecodedWind, drivers::decode::Refusal> wind;
  std::optional<wind::StationQuantities> quantities;  ///< without its time
};

/// Finds and decodes the message in a line: NMEA 0183, FT, UMB, Gill, or keys ("speed=4.2 direction=270"). Nullopt
/// if there is none. The views point into the line.
std::optional<LineLogMessage> find_message(std::string_view line);

}  // namespace yuragi::daemon::tools::csv
