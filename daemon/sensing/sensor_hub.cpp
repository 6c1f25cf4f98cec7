#include "daemon/sensing/sensor_hub.hpp"

#include <algorithm>
#include <functional>
#include <limits>
#include <utility>

#include <fmt/format.h>
#include <malloc.h>
#include <spdlog/spdlog.h>

#include "daemon/sensing/refusal_text.hpp"
#include "engine/base/count_text.hpp"
#include "engine/wind/blend/blended_estimator.hpp"

namespace yuragi::daemon::sensing {
namespace {

using wind::judging::Quantity;
using wind::judging::QuantityWatch;

/// Returns true if it is used although others differ.
bool is_disputed(wind::judging::SensorState state, wind::judging::Vote vote) {
  return is_believed(state) && vote == wind::judging::Vote::kDisputed;
}

/// The key of a state for the ChangeGate: the state, and whether others differ.
std::uint32_t key_of(wind::judging::SensorState state, wind::judging::Vote vote) {
  constexpr std::uint32_t kDisputedBit = 1U << 8U;
  return static_cast<std::uint32_t>(state) | (is_disputed(state, vote) ? kDisputedBit : 0U);
}
/// The key of a link for the ChangeGate: the state; while it is connected, its details, too.
std::uint32_t key_of(const LinkReport& link) {
  const auto state = static_cast<std::uint32_t>(link.state);
  if (link.state != wind::LinkState::kConnected) return state;
  return state | static_cast<std::uint32_t>(std::hash<std::string>{}(link.detail) << 8U);
}
wind::judging::SensorState state_in(std::uint32_t key) {
  return static_cast<wind::judging::SensorState>(key & 0xFFU);
}

bool is_trouble(wind::judging::SensorState state) {
  return !is_believed(state) && state != wind::judging::SensorState::kConnecting;
}

std::string passed_over_text(const ChangeGate& gate) {
  if (gate.passed_over() == 0) return {};
  return fmt::format("; {} short changes in between", gate.passed_over());
}

bool has(const wind::Reading& reading, Quantity quantity) {
  return quantity == Quantity::kDirection ? reading.direction_deg.has_value() : reading.gust_m_s.has_value();
}

/// One that plays a recording does not measure the present wind, and is not compared with those that do.
JuryRules live_rules_of(const settings::SensorConfig& sensor) {
  JuryRules rules = jury_rules_of(sensor);
  rules.is_compared = rules.is_compared && !sensor.driver->plays_recordings;
  return rules;
}

SensorJury make_jury(const settings::Config& config) {
  std::vector<JuryRules> rules;
  for (const settings::SensorConfig& sensor : config.sensors) rules.push_back(live_rules_of(sensor));
  return {rules, config.wind.stale_intervals, config.wind.has_relative_gains};
}

/// The SiteSpectrum that a configuration expects, before any readings.
std::shared_ptr<wind::turbulence::SiteSpectrum> make_site_spectrum(const settings::WindConfig& wind) {
  auto site = std::make_shared<wind::turbulence::SiteSpectrum>();
  site->expect(wind.site_octaves_db);
  return site;
}

}  // namespace

std::shared_ptr<const wind::turbulence::GustNoise> make_gust_noise(const settings::Config& config) {
  auto noise = std::make_shared<const wind::turbulence::GustNoise>(
      wind::turbulence::GustNoiseSettings{.seed = config.seed, .evolves = config.wind.is_evolving});
  malloc_trim(0);  // returns 9 MB of temporary memory to the system
  return noise;
}

wind::blend::Settings blend_settings_of(const settings::Config& config) {
  const settings::WindConfig& wind = config.wind;
  wind::blend::Settings settings{.climate = {.mean_speed_m_s = wind.default_speed_m_s,
                                             .mean_direction_deg = wind.default_direction_deg,
                                             .turbulence_intensity = wind.default_turbulence_intensity,
                                             .seed = config.seed},
                                 .length_m = wind.gust_length_m(),
                                 .gustiness = wind.gustiness,
                                 .handover_s = wind.handover_s,
                                 .stale_intervals = wind.stale_intervals,
                                 .return_after_s = wind.return_after_s,
                                 .rate_hz = config.animation.rate_hz,
                                 .site = make_site_spectrum(wind)};
  for (const settings::SensorConfig& sensor : config.sensors) settings.sources.push_back(sensor.blend);
  // After all sensors, independent of their priorities.
  if (wind.fallback) {
    settings.sources.push_back({.priority = std::numeric_limits<int>::max(),
                                .value = wind.fallback->value.value,
                                .averaging_s = wind.fallback->value.averaging_s,
                                .unchanged_for_s = wind.fallback->unchanged_for_s});
  }
  return settings;
}

wind::blend::BlendedEstimator make_estimator(const settings::Config& config,
                                             std::shared_ptr<const wind::turbulence::GustNoise> noise, double reach_m,
                                             std::shared_ptr<wind::turbulence::SiteSpectrum> site) {
  wind::blend::Settings settings = blend_settings_of(config);
  settings.reach_m = reach_m;
  if (site) settings.site = std::move(site);
  const std::size_t source_count = settings.sources.size();
  return {source_count, settings, std::move(noise)};
}

SensorHub::SensorHub(const settings::Config& config, const drivers::sensor::Clock& clock,
                     std::shared_ptr<const wind::turbulence::GustNoise> noise, Listener listener, double reach_m,
                     SensorThread thread)
    : clock_(clock),
      listener_(std::move(listener)),
      site_(make_site_spectrum(config.wind)),
      estimator_(make_estimator(config, std::move(noise), reach_m, site_)),
      jury_(make_jury(config)),
      fallback_(config, clock) {
  // Construct all before starting any, so that an error in the last one stops no running thread.
  std::vector<std::unique_ptr<drivers::sensor::Sensor>> sensors = settings::open_sensors(config.sensors);
  for (std::size_t index = 0; index < sensors.size(); ++index) {
    Channel channel;
    channel.config = config.sensors[index];
    if (const auto promises = channel.config.driver->promises) {
      const drivers::sensor::PromisedQuantities promised = promises(channel.config.values);
      channel.quantities = {QuantityWatch(promised.direction), QuantityWatch(promised.gust)};
    }
    channel.runner = std::make_unique<SensorRunner>(std::move(sensors[index]), clock_, thread);
    channels_.push_back(std::move(channel));
  }
}

void SensorHub::begin_threads() {
  for (const Channel& channel : channels_) channel.runner->begin_thread();
}

void SensorHub::change(const settings::Config& config) {
  for (std::size_t index = 0; index < channels_.size(); ++index) change(index, config.sensors.at(index));
  fallback_.change(config);
}

void SensorHub::change(std::size_t index, const settings::SensorConfig& config) {
  Channel& channel = channels_[index];
  const settings::SensorConfig before = std::exchange(channel.config, config);
  if (before.by_name.at(settings::kCalibrationTable).all() != config.by_name.at(settings::kCalibrationTable).all()) {
    std::optional<std::pair<wind::Reading, wind::Reading>> last;
    if (const auto& raw = channel.last_raw) {
      last.emplace(before.calibration.applied_to(*raw), config.calibration.applied_to(*raw));
    }
    jury_.recalibrate(index, last);
  }
  jury_.change(index, live_rules_of(config));

  drivers::recording::Player* const player = channel.runner->player();
  if (player == nullptr || !config.values.has("rate")) return;
  const double rate = config.values.number("rate");
  if (rate == before.values.number("rate")) return;
  player->order({.kind = drivers::recording::PlayerOrder::Kind::kRate, .rate = rate});
  channel.runner->wake();
}

const wind::State& SensorHub::advance() {
  for (std::size_t index = 0; index < channels_.size(); ++index) {
    Channel& channel = channels_[index];
    channel.runner->drain([&](const wind::Reading& reading) {
      if (!reading.is_held) {
        ++channel.readings;
        channel.last_raw = reading;
        for (std::size_t i = 0; i < channel.quantities.size(); ++i)
          channel.quantities[i].take(reading.time.mono, reading.speed_m_s, has(reading, static_cast<Quantity>(i)));
        if (listener_) listener_(index, reading);
      }
      take(index, reading);
    });
    channel.runner->drain_quantities([&](const wind::StationQuantities& quantities) {
      if (quantities_listener_) quantities_listener_(index, quantities);
    });
    judge_refusals(index);
  }
  const MonoTime now = clock_.now().mono;
  jury_.compare(now);
  fallback_.advance(is_any_live(),
                    [this](const wind::Reading& reading) { estimator_.accept(channels_.size(), reading); });
  wind_ = estimator_.advance(now);
  for (std::size_t index = 0; index < channels_.size(); ++index) {
    log_link(channels_[index], now);
    log_state(index, now);
  }
  return wind_;
}

/// Calibrates a raw reading, judges it, and passes it to the estimator if it is believed.
void SensorHub::take(std::size_t index, const wind::Reading& raw) {
  Channel& channel = channels_[index];
  wind::Reading reading = channel.config.calibration.applied_to(raw);
  // A time in the future would make all readings that follow late ones.
  reading.time.mono = std::min(reading.time.mono, clock_.now().mono);
  switch (jury_.hear(index, reading)) {
    case SensorJury::Verdict::kDropped:
      break;
    case SensorJury::Verdict::kDoubted:
      ++channel.not_believed;
      break;
    case SensorJury::Verdict::kBelieved:
      estimator_.accept(index, jury_.levelled(index, reading));
      break;
  }
}

/// Readings that the driver refused as implausible count as faults, too.
void SensorHub::judge_refusals(std::size_t index) {
  Channel& channel = channels_[index];
  const std::uint64_t impossible = channel.runner->refused_count(drivers::decode::Refusal::kImplausible);
  jury_.count_impossible(index, impossible - channel.impossible);
  channel.impossible = impossible;
}

SensorEvidence SensorHub::evidence_of(std::size_t index, MonoTime now) const {
  const Channel& channel = channels_[index];
  const wind::judging::ReadingJudge& judge = jury_.judge(index);
  const wind::judging::SensorVote& vote = jury_.vote();
  return {.link = channel.link.state,
          .link_detail = channel.link.detail,
          .report = jury_.report(index, now),
          .is_replay = channel.config.driver->plays_recordings || channel.config.stand_in,
          .fault = judge.fault(),
          .vote = vote.vote_on(index),
          .makes_wind = makes_wind(channel.config.blend.value),
          .same_count = judge.same_count(),
          .same_for_s = judge.same_for_s(),
          .still_for_s = judge.still_for_s(),
          .bad_share = judge.bad_share(),
          .mean_m_s = vote.mean_m_s(index),
          .others_m_s = vote.others_m_s(index),
          .reads_times_group = jury_.reads_times_group(index),
          .is_levelled_at_most = jury_.is_levelled_at_most(index)};
}

/// Logs changes of the link's state, and new details of a connected sensor, but not each failed attempt.
void SensorHub::log_link(Channel& channel, MonoTime now) const {
  if (const std::uint64_t reports = channel.runner->link_reports(); reports != channel.link_reports) {
    channel.link = channel.runner->link();
    channel.link_reports = reports;
    spdlog::debug("sensor {}: {}: {}", channel.config.name, name_of(channel.link.state), channel.link.detail);
  }
  if (channel.link_reports == 0 || !channel.link_gate.offer(key_of(channel.link), now)) return;
  spdlog::info("sensor {}: {}: {}{}", channel.config.name, name_of(channel.link.state), channel.link.detail,
               passed_over_text(channel.link_gate));
}

void SensorHub::log_state(std::size_t index, MonoTime now) {
  Channel& channel = channels_[index];
  const SensorEvidence evidence = evidence_of(index, now);
  const wind::judging::SensorState state = state_of(evidence);
  const wind::judging::SensorState before = state_in(channel.state_gate.reported());
  if (!channel.state_gate.offer(key_of(state, evidence.vote), now)) return;
  const bool is_warning = is_trouble(state) || is_disputed(state, evidence.vote);
  const auto level = is_warning ? spdlog::level::warn : spdlog::level::info;
  spdlog::log(level, "sensor {}: {}: {} (was {}{}; {}, {}, {})", channel.config.name, name_of(state),
              reason_of(state, evidence), name_of(before), passed_over_text(channel.state_gate),
              count_text(channel.readings, "reading"), count_text(channel.runner->frame_count(), "frame"),
              count_text(channel.runner->reconnect_count(), "reconnect"));
}

wind::judging::LearntByName SensorHub::relative_gains() const {
  wind::judging::LearntByName all;
  for (std::size_t index = 0; index < channels_.size(); ++index) {
    const wind::judging::GroupGains::Learnt& learnt = jury_.gains().learnt()[index];
    if (is_known(learnt)) all.emplace(channels_[index].config.name, learnt);
  }
  return all;
}

bool SensorHub::restore_relative_gains(const wind::judging::LearntByName& learnt) {
  std::vector<wind::judging::GroupGains::Learnt> all(channels_.size());
  for (std::size_t index = 0; index < channels_.size(); ++index) {
    const auto found = learnt.find(channels_[index].config.name);
    if (found != learnt.end()) all[index] = found->second;
  }
  return jury_.restore_gains(all);
}

std::vector<wire::SensorStatus> SensorHub::status() const {
  std::vector<wire::SensorStatus> all;
  const MonoTime now = clock_.now().mono;
  for (std::size_t index = 0; index < channels_.size(); ++index) {
    const Channel& channel = channels_[index];
    const LinkReport link = channel.runner->link();
    SensorFacts facts{.name = channel.config.name,
                      .driver = channel.config.driver->name,
                      .evidence = evidence_of(index, now),
                      .value = value_text(channel.config.value, estimator_.taken(index)),
                      .last_raw = channel.last_raw,
                      .counts = counts_of(channel),
                      .quantities = quantities_of(index, now)};
    facts.evidence.link = link.state;
    facts.evidence.link_detail = link.detail;
    all.push_back(sensor_status(facts));
  }
  if (auto status = fallback_.status(estimator_.report(channels_.size()))) all.push_back(std::move(*status));
  return all;
}

std::vector<values::SensorValue> SensorHub::values() const {
  std::vector<values::SensorValue> all;
  all.reserve(channels_.size());
  const MonoTime now = clock_.now().mono;
  for (std::size_t index = 0; index < channels_.size(); ++index) {
    values::SensorValue& value = all.emplace_back();
    value.state = state_in(channels_[index].state_gate.reported());
    const wind::SourceReport report = jury_.report(index, now);
    if (!report.last) continue;
    value.speed_m_s = report.last->speed_m_s;
    value.direction_deg = report.last->direction_deg.value_or(values::SensorValue::kNotSent);
    value.age_s = report.age_s;
  }
  return all;
}

std::vector<wire::QuantityStatus> SensorHub::quantities_of(std::size_t index, MonoTime now) const {
  std::vector<wire::QuantityStatus> all;
  const Channel& channel = channels_[index];
  for (std::size_t i = 0; i < channel.quantities.size(); ++i) {
    const QuantityWatch& watch = channel.quantities[i];
    if (!watch.is_expected()) continue;
    wire::QuantityStatus status{.quantity = static_cast<Quantity>(i), .is_missing = watch.is_missing()};
    if (watch.last()) status.age_s = std::max(seconds(now - *watch.last()), 0.0);
    if (status.is_missing) {
      const DirectionStandIn stand_in = estimator_.is_direction_live(index) ? DirectionStandIn::kOtherSensor
                                        : watch.last()                      ? DirectionStandIn::kLast
                                                                            : DirectionStandIn::kConfigured;
      status.reason = missing_text(status.quantity, status.age_s, stand_in);
    }
    all.push_back(std::move(status));
  }
  return all;
}

SensorCounts SensorHub::counts_of(const Channel& channel) {
  const SensorRunner& runner = *channel.runner;
  SensorCounts counts{.readings = channel.readings,
                      .not_believed = channel.not_believed,
                      .lost = runner.lost_count(),
                      .frames = runner.frame_count(),
                      .reconnects = runner.reconnect_count()};
  for (std::size_t why = 0; why < drivers::decode::kRefusalCount; ++why) {
    counts.refused[why] = runner.refused_count(static_cast<drivers::decode::Refusal>(why));
  }
  return counts;
}

bool SensorHub::is_any_live() const {
  for (std::size_t index = 0; index < channels_.size(); ++index) {
    if (estimator_.report(index).health == wind::SourceHealth::kLive) return true;
  }
  return false;
}

std::vector<NamedPlayer> SensorHub::players() {
  std::vector<NamedPlayer> players;
  for (const Channel& channel : channels_) {
    SensorRunner& runner = *channel.runner;
    drivers::recording::Player* const player = runner.player();
    if (player != nullptr) players.push_back({channel.config.name, player, [&runner] { runner.wake(); }});
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
           .received = message.direction == drivers::sensor::RawDirection::kReceived,
           .bytes = {kept.begin(), kept.end()},
           .length = message.length,
           .lost = message.lost});
    });
  }
}

void SensorHub::log_summary() const {
  for (const wire::SensorStatus& sensor : status()) {
    spdlog::info("sensor {}: {} from {}, {}; refused: {}", sensor.name, count_text(sensor.readings, "reading"),
                 count_text(sensor.frames, "frame"), count_text(sensor.reconnects, "reconnect"), refusal_text(sensor));
  }
  for (const Channel& channel : channels_) {
    const std::uint64_t lost = channel.runner->lost_quantities_count();
    if (lost > 0)
      spdlog::info("sensor {}: dropped {} besides the wind", channel.config.name, count_text(lost, "message"));
  }
}

bool SensorHub::is_finished() const {
  return std::ranges::all_of(
      channels_, [](const Channel& channel) { return channel.runner->link().state == wind::LinkState::kFinished; });
}

}  // namespace yuragi::daemon::sensing
