#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

namespace yuragi::daemon::tools::csv {

/// What a column of numbers measures, as far as its units go.
enum class Dimension : std::uint8_t {
  kNone,         ///< no unit, or one that does not matter
  kTime,         ///< milliseconds and the like
  kSpeed,        ///< in m/s
  kDirection,    ///< in degrees
  kTemperature,  ///< in degrees Celsius
  kPressure,     ///< in hPa
  kHumidity,     ///< in percent
  kRain,         ///< in mm
  kRainRate,     ///< in mm/h
};

/// A unit, which in_base() converts to the one that Dimension names.
struct Unit {
  std::string_view name;  ///< of static storage duration
  double factor = 1.0;
  double offset = 0.0;
  double exponent = 1.0;  ///< of Beaufort's scale 1.5
};

/// factor * value^exponent + offset. A value below zero has no other power than itself.
double in_base(const Unit& unit, double value);

/// Returns the unit that a text names, in any case and punctuation ("km/h", "[m s-1]", "degC", "0.1 m/s"); nullopt
/// if it is not a unit of this dimension. Thread-safe: yes.
std::optional<Unit> find_unit(Dimension dimension, std::string_view text);

/// Returns true for a unit of any dimension.
bool is_any_unit(std::string_view text);

/// The unit of speed that a text is.
inline std::optional<Unit> find_speed_unit(std::string_view text) {
  return find_unit(Dimension::kSpeed, text);
}

/// Returns the unit that is assumed if none is given: the dimension's own.
Unit base_unit(Dimension dimension);

}  // namespace yuragi::daemon::tools::csv
