#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "drivers/decode/decoded_wind.hpp"
#include "drivers/decode/refusal.hpp"
#include "engine/base/result.hpp"
#include "engine/wind/station_quantities.hpp"

namespace yuragi::drivers::decode::davis {

// The WeatherLink Live: JSON that it broadcasts by UDP, and that it replies over HTTP.
// Source: Davis, "WeatherLink Live Local API" (github.com/weatherlink/weatherlink-live-local-api); drivers/SOURCES.md
// S10.2.
//
//   broadcast             {"did": "001D0A...", "ts": ..., "conditions": [record, ...]}
//   current_conditions    {"data": the same, "error": null}
//   real_time             {"data": {"broadcast_port": 22222, "duration": 1200}, "error": null}
//
//   record    data_structure_type 1: txid, wind_speed_last (mph), wind_dir_last, wind_speed_hi_last_10_min (mph),
//   rain_size,
//             rain_rate_last (tips an hour), rainfall_daily (tips); over HTTP also temp (degrees Fahrenheit), hum (%),
//             rx_state (2: the station is searched for, and the values are old)
//             data_structure_type 3: bar_sea_level (inHg)
//
// A missing value is null. In a calm the direction is 0 and has no meaning.

/// One message that has conditions.
struct LiveConditions {
  std::string device;                 ///< "did": which WeatherLink Live it is
  std::optional<double> time_s = {};  ///< "ts": Unix time by its clock; not checked for its range
  int transmitter = 0;
  DecodedWind wind;                    ///< from north
  wind::StationQuantities quantities;  ///< without its time; not checked for its range (wind::plausible_part)
};

/// The conditions of `transmitter` (1 to 8) in a broadcast or a reply to current_conditions; 0: of the first one that
/// has a wind. Or the first thing that is wrong with it: kMalformed, kException (the device replies with an error),
/// kNotMine (no record of that transmitter), kInvalid (no speed, or its transmitter is searched for), kImplausible. An
/// impossible direction is left out, and the reading uncertain; a gust that is below the speed is left out.
/// Thread-safe: yes; allocates.
Result<LiveConditions, Refusal> decode_live_conditions(std::string_view json, int transmitter);

/// The port that the broadcasts go to, in a reply to real_time. kMalformed, kException. Thread-safe: yes; allocates.
Result<std::uint16_t, Refusal> decode_live_broadcast_port(std::string_view json);

}  // namespace yuragi::drivers::decode::davis
