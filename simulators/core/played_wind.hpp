#pragma once

#include <memory>
#include <optional>
#include <string>

#include "engine/wind/turbulence/synthetic_wind.hpp"
#include "simulators/core/faults.hpp"

namespace yuragi::simulators::core {

/// The wind at a simulated sensor, at one moment.
struct PlayedMoment {
  double speed_m_s = 0.0;
  double direction_deg = 0.0;  ///< where it comes from, [0, 360); the last known one if a recording has none
};

/// A wind as a function of time. Thread-safe: no.
class PlayedWind {
 public:
  virtual ~PlayedWind() = default;
  /// The wind `time_s` after the start. Times must not decrease from call to call.
  virtual PlayedMoment at(double time_s) = 0;
};

/// Synthetic wind, without end.
std::unique_ptr<PlayedWind> play_synthetic_wind(const wind::turbulence::SyntheticWindSettings& settings);

/// A recording (.windlog), at the pace at which it was recorded, in a loop. Each reading holds until the next. Throws
/// std::runtime_error if the file cannot be played.
std::unique_ptr<PlayedWind> play_recorded_wind(const std::string& file);

/// What a sensor in that wind measures: the wind itself, or, under the faults kFreeze and kSpike, a repeated or a false
/// value. Thread-safe: no.
class MeasuredWind {
 public:
  explicit MeasuredWind(std::unique_ptr<PlayedWind> wind) : wind_(std::move(wind)) {}

  /// Times must not decrease from call to call.
  PlayedMoment at(double time_s, std::optional<FaultKind> fault);

 private:
  std::unique_ptr<PlayedWind> wind_;
  PlayedMoment last_;
};

}  // namespace yuragi::simulators::core
