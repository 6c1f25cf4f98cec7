#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace yuragi::daemon::tools::csv {

/// Which statistic of an interval a column is, by its name.
enum class Statistic : std::uint8_t {
  kMean,   ///< or not stated
  kMax,    ///< the greatest
  kOther,  ///< the least, a standard deviation: not used
};

/// The parts of the name of a column: "wind_speed_10m_Max (km/h)" is the greatest "windspeed", and ends with "km", "h".
struct Name {
  std::string stem;                     ///< its words without statistic, height and what is in unit_words
  std::vector<std::string> unit_words;  ///< at its end, if they are a unit of any dimension
  std::string unknown_unit;             ///< what stands in the place of a unit, in brackets or behind a comma
  Statistic statistic = Statistic::kMean;
};

/// "Wind Speed (furlongs)" is "windspeed" with an unknown unit, "Wind Speed (10 min max)" the greatest "windspeed".
Name parse_name(std::string_view name);

}  // namespace yuragi::daemon::tools::csv
