#pragma once

#include <array>
#include <cstdint>
#include <string_view>

namespace yuragi::wind {

/// The meaning of the speed in a station's reading.
enum class ReadingValue : std::uint8_t {
  kMean,     ///< the mean wind over a time
  kInstant,  ///< the instantaneous wind: frequencies above half the sampling rate are folded into it (aliasing)
  kMaximum,  ///< the strongest wind of a period: never used as the wind
  kUnknown,  ///< not documented: judged from the readings, otherwise assumed_value() of the interval
};

/// Returns true if such readings are used as wind. Maxima are not.
constexpr bool makes_wind(ReadingValue value) noexcept {
  return value != ReadingValue::kMaximum;
}

/// The names of those that can be stated, in their order.
inline constexpr std::array<std::string_view, 3> kReadingValueNames = {"mean", "instant", "maximum"};

/// The value as which a station's readings are used: stated, judged from them (turbulence::ValueVerdict), or assumed.
struct TakenValue {
  ReadingValue value = ReadingValue::kUnknown;
  bool is_judged = false;
};

/// Returns the assumed value of a station whose value is unknown, by the interval between its readings: the assumption
/// with the smaller maximum error. Means treated as instantaneous give a fraction of the variance, instantaneous wind
/// treated as means a multiple of it: for four winds at worst 1/2.3 and 2.7 times at 14 s, 1/4.0 and 4.1 at 30 s, 1/7.1
/// and 4.9 at 60 s (engine/wind/model.md, "Instantaneous stations", and sampling_proof). Pure.
inline constexpr double kAssumedInstantUpTo_s = 30.0;
constexpr ReadingValue assumed_value(double interval_s) noexcept {
  return interval_s > kAssumedInstantUpTo_s ? ReadingValue::kMean : ReadingValue::kInstant;
}

}  // namespace yuragi::wind
