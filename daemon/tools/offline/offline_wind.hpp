#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "drivers/windlog/windlog_playback.hpp"
#include "engine/wind/blend/blended_estimator.hpp"
#include "engine/wind/judging/reading_judge.hpp"

namespace yuragi {

/// A stretch of log time, from `from_s` on and before `to_s`, in which nothing is heard of the sensor.
struct OfflineGap {
  double from_s = 0.0;
  double to_s = 0.0;
};

struct OfflineWindOptions {
  double rate_hz = 60.0;  ///< states a second of log time
  /// The sensor as a slower one: its readings are vector means over so long, heard at their end.
  std::optional<double> sensor_interval_s{};
  std::vector<OfflineGap> gaps{};
  double until_s = std::numeric_limits<double>::infinity();  ///< no tick after this, and nothing is read beyond it
  /// What is believed of the readings, as in the daemon; empty: everything.
  std::optional<JudgeSettings> judge{};
};

struct OfflineWindResult {
  std::uint64_t readings = 0;  ///< that the estimator heard
  std::uint64_t withheld = 0;  ///< that were not believed
  std::uint64_t states = 0;
  double duration_s = 0.0;  ///< of log time
};

/// Runs an estimator over recordings, as fast as it can: source i hears each reading of `playbacks[i]` at its own log
/// time, and `use` is told the state of each tick, from log time 0 to the last reading or `until_s`. What the options
/// say of the sensor holds for each. Fails where a recording cannot be read on.
Result<OfflineWindResult, Failure> run_offline(std::span<WindlogPlayback> playbacks, BlendedEstimator& estimator,
                                               const OfflineWindOptions& options,
                                               const std::function<void(double time_s, const WindState&)>& use);

/// The same over one recording.
inline Result<OfflineWindResult, Failure> run_offline(WindlogPlayback& playback, BlendedEstimator& estimator,
                                                      const OfflineWindOptions& options,
                                                      const std::function<void(double time_s, const WindState&)>& use) {
  return run_offline(std::span(&playback, 1), estimator, options, use);
}

}  // namespace yuragi
