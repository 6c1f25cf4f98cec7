#include "daemon/sensing/fallback_recording.hpp"

#include <algorithm>
#include <utility>

#include <spdlog/spdlog.h>

#include "daemon/sensing/sensor_status.hpp"
#include "drivers/windlog/windlog_cursor.hpp"
#include "engine/base/count_text.hpp"

namespace yuragi {
namespace {

// A recording that cannot be opened is tried again after so long.
constexpr Nanoseconds kRetryInterval = std::chrono::minutes(1);

SensorConfig fallback_sensor(const FallbackConfig& fallback) {
  const auto drivers = driver_table();
  const auto windlog =
      std::ranges::find_if(drivers, [](const DriverDescription* driver) { return driver->name == "windlog"; });
  const ParameterValues::Map given{{"file", fallback.recording.string()}, {"loop", true}, {"same_time_of_day", true}};
  return default_sensor("fall-back", **windlog, ParameterValues::resolve((*windlog)->parameters, given).value(),
                        fallback.origin);
}

}  // namespace

std::string check_fallback(const FallbackConfig& fallback) {
  const auto refuse = [&fallback](const Failure& failure) {
    const std::string place = fallback.origin.empty() ? "" : fallback.origin + ": ";
    throw ConfigError(place + "wind.fallback_recording: " + failure.message);
  };
  auto cursor = WindlogCursor::open(fallback.recording, "");
  if (!cursor) refuse(cursor.error());
  const auto first = cursor->next();
  if (!first) refuse(first.error());
  return cursor->sensor_of(first->value()).name;
}

FallbackRecording::FallbackRecording(const Config& config, const Clock& clock) : clock_(clock) {
  if (!config.wind.fallback) return;
  const FallbackConfig& fallback = *config.wind.fallback;
  const std::string recorded = check_fallback(fallback);
  const auto same = std::ranges::find(config.sensors, recorded, &SensorConfig::name);
  if (same != config.sensors.end()) {
    calibration_ = same->calibration;
    judged_by_ = same->judge;
  }
  sensor_ = fallback_sensor(fallback);
  file_ = fallback.recording.string();
  after_ = from_seconds(fallback.after_s);
}

void FallbackRecording::advance(bool is_any_sensor_live, const Use& use) {
  if (!sensor_) return;
  const MonoTime now = clock_.now().mono;
  if (is_any_sensor_live) {
    silent_since_.reset();
    return stop();
  }
  if (!silent_since_) silent_since_ = now;
  if (!runner_ && now - *silent_since_ >= after_ && now >= retry_at_) start(now);
  if (!runner_) return;
  runner_->drain([&](const WindReading& raw) {
    ++readings_;
    const WindReading reading = calibration_.applied_to(raw);
    const bool is_judged = judged_by_ && reading.quality != ReadingQuality::kSimulated;
    if (!is_judged || judge_.judge(reading)) use(reading);
  });
  log_changes();
}

void FallbackRecording::start(MonoTime now) {
  try {
    runner_ = std::make_unique<SensorRunner>(open_sensor(*sensor_), clock_);
    judge_ = ReadingJudge(judged_by_.value_or(JudgeSettings{}));
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
  runner_.reset();
  spdlog::info("a sensor is live again: stopped the fallback recording {} after {}", file_,
               count_text(readings_, "reading"));
}

/// Logs each change between readable and unreadable once.
void FallbackRecording::log_changes() {
  const std::uint64_t reports = runner_->link_reports();
  if (reports == logged_link_reports_) return;
  const bool is_first = std::exchange(logged_link_reports_, reports) == 0;
  const LinkReport link = runner_->link();
  const bool has_failed = link.state != LinkState::kConnected;
  if (!is_first && has_failed == has_failed_) return;
  const bool had_failed = std::exchange(has_failed_, has_failed);
  if (!has_failed) {
    spdlog::warn("all sensors are silent: playing {}", file_);
  } else if (!had_failed) {
    spdlog::warn("all sensors are silent, and the fallback recording cannot be played: {}; using the default wind",
                 link.detail);
  }
}

std::optional<wire::SensorStatus> FallbackRecording::status(const SourceReport& report) const {
  if (!runner_) return std::nullopt;
  return fallback_status(sensor_->name, sensor_->driver->name, runner_->link(), report, readings_);
}

}  // namespace yuragi
