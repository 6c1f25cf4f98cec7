#pragma once

#include <cstdint>
#include <optional>

#include "engine/base/time.hpp"

namespace yuragi {

/// How much a reading is worth by its own source's word.
enum class ReadingQuality : std::uint8_t {
  kGood,       ///< measured, and the device says it is well
  kUncertain,  ///< measured, but the device flags it (low battery, partial data)
  kSimulated,  ///< made up by a simulation; nobody may take it for the real wind
};

/// What a sensor said once, decoded, in SI units, before calibration. Finite and physical by the time it is published.
struct WindReading {
  Instant time;            ///< when the answer arrived
  double speed_m_s = 0.0;  ///< at least 0
  std::optional<double>
      direction_deg;               ///< where the wind comes *from*, clockwise from north, [0, 360); empty: not known
  std::optional<double> gust_m_s;  ///< the strongest of the device's own recent past
  ReadingQuality quality = ReadingQuality::kGood;
  /// The reading before, said again because it still holds (a recording that stands still): its source is not silent,
  /// but there is nothing to learn from it, to judge, or to record.
  bool is_held = false;
};

/// The fastest wind that a reading may claim: above the strongest surface gust on record (113 m/s, Barrow Island 1996,
/// WMO Commission for Climatology 2010).
inline constexpr double kMaxPlausibleSpeed_m_s = 120.0;

/// Is everything in the reading finite and within physical range?
bool is_plausible(const WindReading& reading) noexcept;

}  // namespace yuragi
