#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "daemon/sensing/sensor_runner.hpp"
#include "daemon/settings/config.hpp"
#include "engine/wind/judging/reading_judge.hpp"
#include "engine/wind/source_report.hpp"
#include "engine/wire/wire.hpp"

namespace yuragi {

/// The recording that is played when every sensor has been silent for [wind] fallback_after, until one speaks again. It
/// loops, and begins at the time of day that it is, where it has that. For the estimator it is one more source, behind
/// all sensors, so that its wind comes and goes without a jump; it is never recorded, and marked as replayed wherever
/// it is seen. Where it cannot be read any more the default wind blows, and that is logged once.
///
/// A recording holds what a sensor said: its readings are calibrated and judged as those of the configured sensor of
/// the same name as the recorded one, if there is such; else they are judged as any.
/// Belongs to the I/O thread; the file is read on a thread of its own.
class FallbackRecording {
 public:
  using Use = std::function<void(const WindReading&)>;

  /// Looks into the recording, if one is configured. Throws ConfigError where it cannot be played.
  FallbackRecording(const Config& config, const Clock& clock);

  /// Begins or ends to play as the sensors go, and hands on what is due.
  void advance(bool is_any_sensor_live, const Use& use);

  /// How it does, for the stream; nothing while it does not play. `report`: of its source.
  std::optional<wire::SensorStatus> status(const SourceReport& report) const;

 private:
  void start(MonoTime now);
  void stop();
  void log_changes();

  const Clock& clock_;
  std::optional<SensorConfig> sensor_;  ///< nothing: none is configured
  std::string file_;
  Calibration calibration_;
  std::optional<JudgeSettings> judged_by_{JudgeSettings{}};  ///< nothing: all is believed
  ReadingJudge judge_;
  Nanoseconds after_{0};

  std::unique_ptr<SensorRunner> runner_;  ///< while it plays
  std::optional<MonoTime> silent_since_;
  MonoTime retry_at_{};
  std::uint64_t readings_ = 0;
  std::uint64_t logged_link_reports_ = 0;
  bool has_failed_ = false;  ///< and that is logged
};

/// Can it be played? Throws ConfigError, at its place in the file, where it cannot. Answers the name of the sensor that
/// was recorded.
std::string check_fallback(const FallbackConfig& fallback);

}  // namespace yuragi
