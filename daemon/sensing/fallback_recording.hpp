#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "daemon/sensing/sensor_runner.hpp"
#include "daemon/settings/config.hpp"
#include "engine/wind/judging/reading_judge.hpp"
#include "engine/wind/source_report.hpp"
#include "engine/wire/wire.hpp"

namespace yuragi::daemon::sensing {

/// Plays a recording while every sensor has been silent for [wind] fallback_after, until one is live again. It loops,
/// and begins at the present time of day if the recording contains it. For the estimator it is one more source, of
/// lower priority than all sensors, so that its wind is faded in and out. It is never recorded, and its state is
/// "replayed". If it can no longer be read, the default wind is used, which is logged once.
///
/// The readings in a recording are raw: they are calibrated and judged with the settings of the configured sensor that
/// has the same name as the recorded one; if there is none, uncalibrated and judged with the defaults.
/// Belongs to the I/O thread; the file is read on a thread of its own, for whose end that one does not wait.
class FallbackRecording {
 public:
  using Use = std::function<void(const wind::Reading&)>;

  /// Checks the recording, if one is configured. Throws ConfigError if it cannot be played.
  FallbackRecording(const settings::Config& config, const drivers::sensor::Clock& clock);

  /// Calibrates and judges from now on by a configuration with the same recording.
  void change(const settings::Config& config);

  /// Starts or stops playing, and passes readings that are due to `use`.
  void advance(bool is_any_sensor_live, const Use& use);

  /// Its status for the stream; nullopt while it does not play. `report`: of its source.
  std::optional<wire::SensorStatus> status(const wind::SourceReport& report) const;

 private:
  void take_settings(const settings::Config& config);
  void start(MonoTime now);
  void stop();
  void log_changes();

  const drivers::sensor::Clock& clock_;
  std::optional<settings::SensorConfig> sensor_;  ///< none: no recording is configured
  std::string file_;
  std::string recorded_;  ///< the name of the recorded sensor
  wind::judging::Calibration calibration_;
  std::optional<wind::judging::JudgeSettings> judged_by_{
      wind::judging::JudgeSettings{}};  ///< none: every reading is believed
  wind::judging::ReadingJudge judge_;
  Nanoseconds after_{0};

  std::unique_ptr<SensorRunner> runner_;               ///< while it plays
  std::vector<std::unique_ptr<SensorRunner>> ending_;  ///< that were stopped, and may still wait for the disk
  std::optional<MonoTime> silent_since_;
  MonoTime retry_at_{};
  std::uint64_t readings_ = 0;
  std::uint64_t logged_link_reports_ = 0;
  bool has_failed_ = false;  ///< and this has been logged
};

/// Returns the name of the recorded sensor. Throws ConfigError, with the place in the file, if it cannot be played.
std::string check_fallback(const settings::FallbackConfig& fallback);

}  // namespace yuragi::daemon::sensing
