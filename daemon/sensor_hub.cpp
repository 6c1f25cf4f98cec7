#include "daemon/sensor_hub.hpp"

#include <algorithm>
#include <limits>

#include <spdlog/spdlog.h>

#include "daemon/sensor_table.hpp"
#include "engine/wind/blended_estimator.hpp"

namespace yuragi {
namespace {

std::string_view name_of(SourceHealth health) {
  switch (health) {
    case SourceHealth::kSilent:
      return "silent";
    case SourceHealth::kLive:
      return "live";
    case SourceHealth::kStale:
      return "stale";
  }
  return "?";
}

}  // namespace

std::shared_ptr<const GustNoise> make_gust_noise(const Config& config) {
  return std::make_shared<const GustNoise>(
      GustNoiseSettings{.seed = config.seed, .evolves = config.wind.flag("evolving")});
}

std::unique_ptr<WindEstimator> make_estimator(const Config& config, std::shared_ptr<const GustNoise> noise) {
  BlendSettings settings{.climate = {.mean_speed_m_s = config.wind.number("default_speed"),
                                     .mean_direction_deg = config.wind.number("default_direction"),
                                     .turbulence_intensity = config.wind.number("default_turbulence"),
                                     .seed = config.seed},
                         .length_m = config.wind.number("default_length"),
                         .handover_s = config.wind.number("handover"),
                         .stale_intervals = config.wind.number("stale_intervals"),
                         .rate_hz = config.animation.number("rate")};
  // Behind all sensors, whatever their priorities.
  std::size_t source_count = config.sensors.size();
  if (has_fallback(config)) {
    settings.sources.resize(source_count++);
    settings.sources.push_back({.priority = std::numeric_limits<int>::max()});
  }
  return std::make_unique<BlendedEstimator>(source_count, settings, std::move(noise));
}

SensorHub::SensorHub(const Config& config, const Clock& clock, std::shared_ptr<const GustNoise> noise,
                     Listener listener)
    : clock_(clock),
      listener_(std::move(listener)),
      estimator_(make_estimator(config, std::move(noise))),
      fallback_(config, clock) {
  // Make all of them before any of them starts, so that a mistake in the last stops no running thread.
  std::vector<std::unique_ptr<Sensor>> sensors;
  for (const SensorConfig& sensor : config.sensors) sensors.push_back(open_sensor(sensor));
  for (std::size_t index = 0; index < sensors.size(); ++index) {
    Channel channel;
    channel.config = config.sensors[index];
    channel.calibration = calibration_of(channel.config);
    channel.runner = std::make_unique<SensorRunner>(std::move(sensors[index]), clock_);
    channels_.push_back(std::move(channel));
  }
}

const WindState& SensorHub::advance() {
  for (std::size_t index = 0; index < channels_.size(); ++index) {
    Channel& channel = channels_[index];
    channel.runner->drain([&](const WindReading& reading) {
      if (!reading.is_held) {
        ++channel.readings;
        if (listener_) listener_(index, reading);
      }
      estimator_->accept(index, channel.calibration.applied_to(reading));
    });
  }
  fallback_.advance(is_any_live(),
                    [this](const WindReading& reading) { estimator_->accept(channels_.size(), reading); });
  wind_ = estimator_->advance(clock_.now().mono);
  for (std::size_t index = 0; index < channels_.size(); ++index) log_changes(index);
  return wind_;
}

void SensorHub::log_changes(std::size_t index) {
  Channel& channel = channels_[index];

  // The link: a change of its state is news; one more failed attempt is not.
  if (const std::uint64_t reports = channel.runner->link_reports(); reports != channel.logged_link_reports) {
    const LinkReport link = channel.runner->link();
    if (link.state != channel.logged_link || channel.logged_link_reports == 0) {
      spdlog::info("sensor {}: {}: {}", channel.config.name, name_of(link.state), link.detail);
    } else {
      spdlog::debug("sensor {}: {}: {}", channel.config.name, name_of(link.state), link.detail);
    }
    channel.logged_link_reports = reports;
    channel.logged_link = link.state;
  }

  const SourceReport report = estimator_->report(index);
  if (report.health != channel.logged_health) {
    spdlog::info("sensor {}: {} (was {}); last reading {:.1f} s ago, interval {:.3g} s; {} frames, {} reconnects",
                 channel.config.name, name_of(report.health), name_of(channel.logged_health), report.age_s,
                 report.interval_s, channel.runner->frame_count(), channel.runner->reconnect_count());
    channel.logged_health = report.health;
  }
}

std::vector<wire::SensorStatus> SensorHub::status() const {
  std::vector<wire::SensorStatus> all;
  for (std::size_t index = 0; index < channels_.size(); ++index) {
    const Channel& channel = channels_[index];
    const LinkReport link = channel.runner->link();
    const SourceReport report = estimator_->report(index);

    wire::SensorStatus status;
    status.name = channel.config.name;
    status.driver = channel.config.driver->name;
    status.link = static_cast<std::uint8_t>(link.state);
    status.health = static_cast<std::uint8_t>(report.health);
    status.detail = link.detail;
    if (report.last) {
      status.speed_m_s = report.last->speed_m_s;
      status.direction_deg = report.last->direction_deg;
      status.gust_m_s = report.last->gust_m_s;
      status.simulated = report.last->quality == ReadingQuality::kSimulated;
    }
    status.age_s = report.age_s;
    status.interval_s = report.interval_s;
    status.readings = channel.readings;
    for (std::size_t why = 0; why < kRefusalCount; ++why) {
      const auto refusal = static_cast<Refusal>(why);
      if (const std::uint64_t count = channel.runner->refused_count(refusal)) {
        status.refused.emplace_back(name_of(refusal), count);
      }
    }
    if (const std::uint64_t lost = channel.runner->lost_count()) status.refused.emplace_back("lost", lost);
    status.frames = channel.runner->frame_count();
    status.reconnects = channel.runner->reconnect_count();
    status.replayed = channel.config.driver->plays_recordings;
    all.push_back(std::move(status));
  }
  if (auto status = fallback_.status(estimator_->report(channels_.size()))) all.push_back(std::move(*status));
  return all;
}

bool SensorHub::is_any_live() const {
  for (std::size_t index = 0; index < channels_.size(); ++index) {
    if (estimator_->report(index).health == SourceHealth::kLive) return true;
  }
  return false;
}

std::vector<NamedPlayer> SensorHub::players() {
  std::vector<NamedPlayer> players;
  for (const Channel& channel : channels_) {
    SensorRunner& runner = *channel.runner;
    if (runner.player() == nullptr) continue;
    players.push_back({channel.config.name, runner.player(), [&runner] { runner.wake(); }});
  }
  return players;
}

void SensorHub::trace(const std::function<bool(std::string_view)>& is_wanted) {
  for (const Channel& channel : channels_) channel.runner->trace(is_wanted(channel.config.name));
}

void SensorHub::drain_traces(const std::function<void(const wire::RawTrace&)>& use) {
  const auto nanoseconds = [](auto time) { return std::int64_t{time.time_since_epoch().count()}; };
  for (const Channel& channel : channels_) {
    channel.runner->drain_trace([&](const RawMessage& message) {
      const auto kept = message.kept();
      use({.sensor = channel.config.name,
           .mono_ns = nanoseconds(message.time.mono),
           .utc_ns = nanoseconds(message.time.utc),
           .received = message.direction == RawDirection::kReceived,
           .bytes = {kept.begin(), kept.end()},
           .length = message.length,
           .lost = message.lost});
    });
  }
}

void SensorHub::log_summary() const {
  for (const wire::SensorStatus& sensor : status()) {
    spdlog::info("sensor {}: {} readings from {} frames, {} reconnects; refused: {}", sensor.name, sensor.readings,
                 sensor.frames, sensor.reconnects, refusal_text(sensor));
  }
}

bool SensorHub::is_finished() const {
  return std::ranges::all_of(
      channels_, [](const Channel& channel) { return channel.runner->link().state == LinkState::kFinished; });
}

}  // namespace yuragi
