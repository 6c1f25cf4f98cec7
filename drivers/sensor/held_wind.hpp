#pragma once

#include <optional>

#include "drivers/decode/refusal.hpp"
#include "engine/base/result.hpp"
#include "engine/base/time.hpp"
#include "engine/wind/wind_reading.hpp"

namespace yuragi::drivers::sensor {

/// Joins speed, direction and gust that arrive in messages of their own: each speed gives a reading, with the last
/// direction and the last gust, if they are not older than `hold`. Directions are in degrees, where the wind comes
/// from; speeds in m/s. Not thread-safe. Realtime-safe: yes.
class HeldWind {
 public:
  explicit HeldWind(Nanoseconds hold) noexcept : hold_(hold) {}

  /// Forgets direction and gust: the device was opened again.
  void clear() noexcept;

  /// Holds a direction; nullopt: the device reports that it has none, and the last one is not used any more. Returns
  /// false if it is impossible (decode::wrapped_direction_deg()): then it is lost.
  bool hold_direction(std::optional<double> direction_deg, MonoTime now) noexcept;
  /// A direction has arrived that cannot be read: the last one is not used any more, and readings are uncertain until
  /// the next direction, or for as long as `hold`.
  void lose_direction(MonoTime now) noexcept;
  /// Holds a gust; nullopt: the device reports that it has none. Returns false if no gust is that strong, or it is
  /// negative; then none is held.
  bool hold_gust(std::optional<double> gust_m_s, MonoTime now) noexcept;

  /// Returns the reading of a speed; kImplausible if no wind is that fast. A held gust below the speed is left out.
  Result<wind::Reading, decode::Refusal> reading_of(double speed_m_s, const Instant& now) const noexcept;

 private:
  /// A value, and the time of the message with it.
  struct Held {
    std::optional<double> value = {};
    MonoTime since = {};
  };

  std::optional<double> still_held(const Held& held, MonoTime now) const noexcept;

  Nanoseconds hold_;
  Held direction_deg_;
  Held gust_m_s_;
  bool is_lost_ = false;  // the last direction could not be read
};

}  // namespace yuragi::drivers::sensor
