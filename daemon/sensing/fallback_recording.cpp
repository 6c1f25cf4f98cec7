#include "daemon/sensing/fallback_recording.hpp"

#include <algorithm>
#include <utility>

#include <spdlog/spdlog.h>

#include "daemon/sensing/sensor_status.hpp"
#include "drivers/windlog/windlog_cursor.hpp"
#include "engine/base/count_text.hpp"

namespace yuragi::daemon::sensing {
namespace {

// A recording that cannot be opened is tried again after this.
constexpr Nanoseconds kRetryInterval = std::chrono::minutes(1);

settings::SensorConfig fallback_sensor(const settings::FallbackConfig& fallback) {
  const drivers::sensor::DriverDescription& windlog = drivers::sensor::recording_driver();
  const ParameterValues::Map given{{"file", fallback.recording.string()}, {"loop", true}, {"same_time_of_day", true}};
  return settings::default_sensor("fall-back", windlog, ParameterValues::resolve(windlog.parameters, given).value(),
                                  fallback.origin);
}

}  // namespace

std::string check_fallback(const settings::FallbackConfig& fallback) {
  const auto refuse = [&fallback](const Failure& failure) {
    const std::string place = fallback.origin.empty() ? "" : fallback.origin + ": ";
    throw settings::ConfigError(place + "wind.fallback_recording: " + failure.message);
  };
  auto cursor = drivers::windlog::Cursor::open(fallback.recording, "");
  if (!cursor) refuse(cursor.error());
  const auto first = cursor->next();
  if (!first) refuse(first.error());
  return cursor->sensor_of(first->value()).name;
}

FallbackRecording::FallbackRecording(const settings::Config& config, const drivers::sensor::Clock& clock)
    : clock_(clock) {
  if (!config.wind.fallback) return;
  const settings::FallbackConfig& fallback = *config.wind.fallback;
  recorded_ = check_fallback(fallback);
  take_settings(config);
  sensor_ = fallback_sensor(fallback);
  file_ = fallback.recording.string();
  after_ = from_seconds(fallback.after_s);
}

void FallbackRecording::change(const settings::Config& config) {
  if (!sensor_) return;
  take_settings(config);
  // It plays rarely, and starts again each time: findings about its last readings can be dropped.
  judge_ = wind::judging::ReadingJudge(judged_by_.value_or(wind::judging::JudgeSettings{}));
}

/// Takes the settings of the sensor that was recorded, if it is configured.
void FallbackRecording::take_settings(const settings::Config& config) {
  const auto same = std::ranges::find(config.sensors, recorded_, &settings::SensorConfig::name);
  if (same == config.sensors.end()) return;
  calibration_ = same->calibration;
  judged_by_ = same->judge;
}

void FallbackRecording::advance(bool is_any_sensor_live, const Use& use) {
  if (!sensor_) return;
  std::erase_if(ending_, [](const auto& runner) { return runner->has_ended(); });
  const MonoTime now = clock_.now().mono;
  if (is_any_sensor_live) {
    silent_since_.reset();
    return stop();
  }
  if (!silent_since_) silent_since_ = now;
  if (!runner_ && now - *silent_since_ >= after_ && now >= retry_at_) start(now);
  if (!runner_) return;
  runner_->drain([&](const wind::Reading& raw) {
    ++readings_;
    const wind::Reading reading = calibration_.applied_to(raw);
    const bool is_judged = judged_by_ && reading.quality != wind::ReadingQuality::kSimulated;
    if (!is_judged || judge_.judge(reading)) use(reading);
  });
  log_changes();
}

void FallbackRecording::start(MonoTime now) {
  try {
    runner_ = std::make_unique<SensorRunner>(settings::open_sensor(*sensor_), clock_);
    judge_ = wind::judging::ReadingJudge(judged_by_.value_or(wind::judging::JudgeSettings{}));
    readings_ = 0;
    logged_link_reports_ = 0;
  } catch (const std::exception& error) {
    retry_at_ = now + kRetryInterval;
    if (!std::exchange(has_failed_, true)) {
      spdlog::warn("all sensors are silent, and the fallback recording cannot be played: {}; using the default wind",
                   error.what());
    }
  }
}

void FallbackRecording::stop() {
  if (!runner_) return;
  runner_->end();
  ending_.push_back(std::move(runner_));
  spdlog::info("a sensor is live again: stopped the fallback recording {} after {}", file_,
               count_text(readings_, "reading"));
}

/// Logs each change between readable and unreadable once.
void FallbackRecording::log_changes() {
  const std::uint64_t reports = runner_->link_reports();
  if (reports == logged_link_reports_) return;
  const bool is_first = std::exchange(logged_link_reports_, reports) == 0;
  const LinkReport link = runner_->link();
  const bool has_failed = link.state != wind::LinkState::kConnected;
  if (!is_first && has_failed == has_failed_) return;
  const bool had_failed = std::exchange(has_failed_, has_failed);
  if (!has_failed) {
    spdlog::warn("all sensors are silent: playing {}", file_);
  } else if (!had_failed) {
    spdlog::warn("all sensors are silent, and the fallback recording cannot be played: {}; using the default wind",
                 link.detail);
  }
}

std::optional<wire::SensorStatus> FallbackRecording::status(const wind::SourceReport& report) const {
  if (!runner_) return std::nullopt;
  return fallback_status(sensor_->name, sensor_->driver->name, runner_->link(), report, readings_);
}

}  // namespace yuragi::daemon::sensing
