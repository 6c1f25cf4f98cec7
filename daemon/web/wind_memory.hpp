#pragma once

#include <cstddef>
#include <deque>
#include <optional>

#include "engine/wire/wire.hpp"

namespace yuragi::daemon::web {

/// The wind at a moment, as people are shown it.
struct WindMoment {
  double mono_s = 0.0;                 ///< of the clock that add() is given
  std::optional<double> measured_m_s;  ///< of the leading sensor; nullopt: none is believed, or it sent no speed
  double blended_m_s = 0.0;
  double noise_share = 0.0;  ///< of the blended wind, 0 to 1
};

/// Returns the speed of the sensor that people are shown first: of those that are believed a live one before a replayed
/// and a simulated one, and of these the first with a speed.
std::optional<double> measured_speed_m_s(const wire::Sensors& sensors);

/// The wind of the last minutes, so that a page that is opened shows more than what comes from then on.
/// Memory is bounded: 3 minutes at one moment a second. Thread-safe: no.
class WindMemory {
 public:
  static constexpr double kLength_s = 180.0;
  static constexpr double kInterval_s = 1.0;

  /// Keeps the wind of this status, unless the last moment is less than the interval old. `mono_s`: now, of a clock
  /// that never goes back.
  void add(double mono_s, const wire::Sensors& sensors);

  /// Oldest first.
  const std::deque<WindMoment>& moments() const { return moments_; }

 private:
  std::deque<WindMoment> moments_;
};

}  // namespace yuragi::daemon::web
