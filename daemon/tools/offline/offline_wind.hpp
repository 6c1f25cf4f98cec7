#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "daemon/sensing/sensor_jury.hpp"
#include "drivers/windlog/windlog_playback.hpp"
#include "engine/wind/blend/blended_estimator.hpp"

namespace yuragi::daemon::tools::offline {

/// A stretch of log time, from `from_s` on and before `to_s`, whose readings are left out.
struct Gap {
  double from_s = 0.0;
  double to_s = 0.0;
};

struct WindOptions {
  double rate_hz = 60.0;  ///< states per second of log time
  /// Simulates a slower sensor: its readings are vector means over so long, available at the end of each.
  std::optional<double> sensor_interval_s{};
  std::vector<Gap> gaps{};
  double until_s = std::numeric_limits<double>::infinity();  ///< the last tick; nothing is read beyond it
  /// Judges the readings of each recording, and compares several, as the daemon does; as it is, all are believed.
  sensing::JuryRules rules{};
  double stale_intervals = wind::blend::Settings{}.stale_intervals;  ///< silent for this long: not compared
  bool has_relative_gains = true;  ///< those that are compared are levelled to their common mean
};

struct WindResult {
  std::uint64_t readings = 0;  ///< that the estimator took
  std::uint64_t withheld = 0;  ///< that were not believed
  std::uint64_t states = 0;
  double duration_s = 0.0;  ///< of log time
};

/// Runs an estimator over recordings, as fast as possible: source i takes each reading of `playbacks[i]` at its own log
/// time, and `use` is called with the state of each tick, from log time 0 to the last reading or `until_s`. The options
/// of the sensor apply to each source. Fails if a recording cannot be read.
Result<WindResult, Failure> run_offline(std::span<drivers::windlog::Playback> playbacks,
                                        wind::blend::BlendedEstimator& estimator, const WindOptions& options,
                                        const std::function<void(double time_s, const wind::State&)>& use);

/// The same over one recording.
inline Result<WindResult, Failure> run_offline(drivers::windlog::Playback& playback,
                                               wind::blend::BlendedEstimator& estimator, const WindOptions& options,
                                               const std::function<void(double time_s, const wind::State&)>& use) {
  return run_offline(std::span(&playback, 1), estimator, options, use);
}

}  // namespace yuragi::daemon::tools::offline
