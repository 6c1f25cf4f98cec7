#pragma once

#include <cstdint>
#include <optional>

#include "engine/base/state_pass.hpp"
#include "engine/base/time.hpp"

namespace yuragi::wind {

/// The quality of a reading as its own device reports it.
enum class ReadingQuality : std::uint8_t {
  kGood,       ///< measured, without a flag by the device
  kUncertain,  ///< measured, but the device flags it (low battery, partial data)
  kSimulated,  ///< made by a simulation: must not be treated as real wind
};

/// One reading of a sensor, decoded, in SI units, before calibration. Finite and physical by the time it is published.
struct Reading {
  Instant time;            ///< when it arrived
  double speed_m_s = 0.0;  ///< at least 0
  std::optional<double>
      direction_deg;               ///< where the wind comes *from*, clockwise from north, [0, 360); nullopt: unknown
  std::optional<double> gust_m_s;  ///< maximum of the device's own recent past
  ReadingQuality quality = ReadingQuality::kGood;
  /// A repetition of the reading before, which still holds (a paused recording): its source is not silent, but the
  /// repetition is not used for fits, checked or recorded.
  bool is_held = false;

  void list_state(StatePass& pass) {
    pass(time.mono, time.utc, speed_m_s, direction_deg, gust_m_s, is_held);
    pass.choice(quality, ReadingQuality::kSimulated);
  }
};

/// The fastest wind that a reading may claim: above the strongest surface gust on record (113 m/s, Barrow Island 1996,
/// WMO Commission for Climatology 2010).
inline constexpr double kMaxPlausibleSpeed_m_s = 120.0;

/// Returns true if everything in the reading is finite and within its physical range.
bool is_plausible(const Reading& reading) noexcept;

/// Have both the same speed, direction and gust, bit for bit?
bool has_same_values(const Reading& a, const Reading& b) noexcept;

}  // namespace yuragi::wind
