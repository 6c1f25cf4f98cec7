#pragma once

#include <memory>
#include <optional>
#include <string>

#include "engine/wind/turbulence/synthetic_wind.hpp"
#include "simulators/faults.hpp"

namespace yuragi::sim {

/// The air in front of a simulated sensor, at one moment.
struct PlayedMoment {
  double speed_m_s = 0.0;
  double direction_deg = 0.0;  ///< where it comes from, [0, 360); the last known one where a recording has none
};

/// A wind that runs on with time. Thread-safe: no.
class PlayedWind {
 public:
  virtual ~PlayedWind() = default;
  /// The wind `time_s` after the start; asked for times that never go back.
  virtual PlayedMoment at(double time_s) = 0;
};

/// Synthetic wind, without end.
std::unique_ptr<PlayedWind> play_synthetic_wind(const SyntheticWindSettings& settings);

/// A recording (.windlog), at the pace at which it was recorded, again and again. Each reading holds until the next.
/// Throws std::runtime_error where the file cannot be played.
std::unique_ptr<PlayedWind> play_recorded_wind(const std::string& file);

/// What a sensor that stands in that wind measures: the wind, but for the faults kFreeze and kSpike.
/// Thread-safe: no.
class MeasuredWind {
 public:
  explicit MeasuredWind(std::unique_ptr<PlayedWind> wind) : wind_(std::move(wind)) {}

  /// Asked for times that never go back.
  PlayedMoment at(double time_s, std::optional<FaultKind> fault);

 private:
  std::unique_ptr<PlayedWind> wind_;
  PlayedMoment last_;
};

}  // namespace yuragi::sim
