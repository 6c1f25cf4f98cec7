#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "daemon/tools/csv/csv_time.hpp"
#include "drivers/decode/decoded_wind.hpp"
#include "drivers/decode/refusal.hpp"
#include "engine/base/result.hpp"
#include "engine/wind/station_quantities.hpp"

namespace yuragi::daemon::tools::logs {

/// An anemometer's message in a log.
struct Message {
  std::string prefix = {};  ///< what the logger wrote before it
  /// Which of a log's winds it is: "MWV R of WI", "Gill of Q", "NMEA 2000 apparent", "key wind_avg_m_s"; empty if the
  /// message is refused.
  std::string source = {};
  Result<drivers::decode::DecodedWind, drivers::decode::Refusal> wind = drivers::decode::Refusal::kNotMine;
  std::optional<wind::StationQuantities> quantities = {};  ///< without its time
  std::optional<csv::Time> time = {};                      ///< which it has itself
  std::optional<Nanoseconds> time_of_day = {};             ///< the same without a day
};

}  // namespace yuragi::daemon::tools::logs
