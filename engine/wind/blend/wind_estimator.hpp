#pragma once

#include <cstddef>
#include <optional>

#include "engine/wind/ground/ground_wind.hpp"
#include "engine/wind/ground/wind_stroke.hpp"
#include "engine/wind/wind_reading.hpp"
#include "engine/wind/wind_state.hpp"

namespace yuragi {

/// The state of a source of readings, seen from the estimator.
enum class SourceHealth : std::uint8_t {
  kSilent,  ///< no reading yet
  kLive,
  kStale,  ///< silent for longer than its own measured interval explains
};

struct SourceReport {
  SourceHealth health = SourceHealth::kSilent;
  double interval_s = 0.0;  ///< measured: the median of the last intervals; 0 before the second reading
  double age_s = 0.0;       ///< of its last reading
  std::optional<WindReading> last;
};

/// Makes of readings (slow, gappy, from several sources) the wind that moves things.
///
/// Contract of every implementation: the state is finite whatever comes in; it is continuous, with no jump at a new
/// reading, a loss or a return; time is a parameter and may not go back (a call with an earlier time changes nothing).
/// Thread-safe: no; one thread owns it. Realtime-safe after construction: yes.
class WindEstimator {
 public:
  virtual ~WindEstimator() = default;

  /// Takes a reading of source `source` (below the count given at construction). An implausible one is ignored and
  /// answered with false.
  virtual bool accept(std::size_t source, const WindReading& reading) noexcept = 0;

  /// Advances to `now` and returns the wind where it is measured.
  virtual WindState advance(MonoTime now) noexcept = 0;

  /// The same wind over the ground, as of the last advance(); without tapes.
  virtual const GroundWind& ground() const noexcept = 0;
  /// What the last advance() adds to the tapes.
  virtual const WindStroke& stroke() const noexcept = 0;

  /// How `source` does, as of the last advance(). One that is not there is silent.
  virtual SourceReport report(std::size_t source) const noexcept = 0;
};

}  // namespace yuragi
