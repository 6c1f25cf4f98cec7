#include "daemon/tools/offline/lockstep_replay.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <system_error>

#include <fmt/format.h>

#include "daemon/animation/animation.hpp"
#include "daemon/animation/motion_made_of.hpp"
#include "daemon/sensing/held_clock.hpp"
#include "daemon/sensing/player_director.hpp"
#include "daemon/sensing/recorded_source.hpp"
#include "daemon/sensing/sensor_hub.hpp"
#include "daemon/sensing/sensor_jury.hpp"
#include "daemon/shaping/wind_shaper.hpp"
#include "daemon/tools/offline/kept_states.hpp"
#include "engine/base/snapshot.hpp"
#include "engine/math/philox.hpp"
#include "engine/pose/pose_hash.hpp"

namespace yuragi::daemon::tools::offline {
namespace {

std::uint64_t hash_poses(std::uint64_t hash, std::span<const pose::Pose* const> poses) {
  for (const pose::Pose* pose : poses) hash = pose::pose_hash(hash, *pose);
  return hash;
}

/// The animation, tick by tick, and the figures of what moved it.
class Ticks {
 public:
  /// In the first `lead_s` nothing is counted or handed on.
  Ticks(animation::Animation& animation, double rate_hz, double lead_s, const std::function<void(double)>& progress,
        const UseTick& use)
      : animation_(animation),
        rate_hz_(rate_hz),
        lead_ticks_(static_cast<std::uint64_t>(std::llround(lead_s * rate_hz))),
        progress_(progress),
        use_(use) {}

  /// The time of the next tick on the clock of sensors and wind, from 0 on.
  Nanoseconds clock() const { return from_seconds(static_cast<double>(count()) / rate_hz_); }
  /// The log time of the next tick, while is_leading_in() that of the first one.
  double now_s() const { return static_cast<double>(result_.ticks) / rate_hz_; }
  bool is_leading_in() const { return led_ < lead_ticks_; }
  /// All ticks, led in or counted.
  std::uint64_t count() const { return led_ + result_.ticks; }
  /// The lead-in goes on until end_lead_in().
  void lead_in_until_ended() { lead_ticks_ = std::numeric_limits<std::uint64_t>::max(); }
  void end_lead_in() { lead_ticks_ = led_; }
  /// Leaves out a tick of the lead-in, of which only the wind counts.
  void pass_over() { ++led_; }

  void add(const wind::Reading& reading) {
    if (is_leading_in()) return;
    ++result_.readings;
    result_.reading_mean_m_s += reading.speed_m_s;
    result_.reading_max_m_s = std::max(result_.reading_max_m_s, reading.speed_m_s);
  }

  /// `ceiling_gain`: the factor (above 0) by which the ceiling has held back the wind of this tick.
  void step(const wind::ground::DrivingWind& wind, double ceiling_gain, UtcTime recorded, double left_s) {
    const double time_s = now_s();
    animation_.step(wind, 1.0 / rate_hz_);
    if (is_leading_in()) {
      ++led_;
      return;
    }
    result_.pose_hash = hash_poses(result_.pose_hash, animation_.poses());
    if (use_) {
      use_({.log_time_s = time_s, .recorded = recorded, .left_s = left_s, .wind = wind.state, .animation = animation_});
    }
    if (wind.state.source == wind::Source::kLive) {
      const double speed_m_s = speed_of(wind.state.wind);
      ++result_.live_ticks;
      result_.wind_mean_m_s += speed_m_s;
      result_.wind_max_m_s = std::max(result_.wind_max_m_s, speed_m_s);
      const double free_m_s = speed_m_s / ceiling_gain;
      result_.free_wind_mean_m_s += free_m_s;
      result_.free_wind_max_m_s = std::max(result_.free_wind_max_m_s, free_m_s);
      if (ceiling_gain < 1.0) ++result_.held_back_ticks;
    }
    const auto ticks_between_progress = static_cast<std::uint64_t>(60.0 * rate_hz_);
    if (progress_ && result_.ticks % ticks_between_progress == 0) progress_(time_s);
    ++result_.ticks;
  }

  LockstepResult result() const {
    LockstepResult result = result_;
    result.log_duration_s = now_s();
    if (result.readings > 0) result.reading_mean_m_s /= static_cast<double>(result.readings);
    if (result.live_ticks > 0) {
      result.wind_mean_m_s /= static_cast<double>(result.live_ticks);
      result.free_wind_mean_m_s /= static_cast<double>(result.live_ticks);
    }
    return result;
  }

 private:
  animation::Animation& animation_;
  double rate_hz_;
  std::uint64_t lead_ticks_;
  std::uint64_t led_ = 0;  // of these, done
  const std::function<void(double)>& progress_;
  const UseTick& use_;
  LockstepResult result_;
};

/// The recording's clock, interpolated between its readings.
class RecordedClock {
 public:
  UtcTime at(Nanoseconds log_time, UtcTime read) {
    if (read != read_) {
      read_ = read;
      read_at_ = log_time;
    }
    return read_ + (log_time - read_at_);
  }

 private:
  UtcTime read_{};
  Nanoseconds read_at_{0};
};

/// What the poses of a replay follow from, besides the version of the motion.
std::uint64_t replay_made_of(const settings::Config& one_source, const std::filesystem::path& recording,
                             const std::string& sensor, double lead_s) {
  std::error_code error;
  const auto size = std::filesystem::file_size(recording, error);
  const auto written = std::filesystem::last_write_time(recording, error).time_since_epoch().count();
  return math::stream_id(fmt::format("{} {} {} {} {} {}", animation::motion_made_of(one_source, 1), kMotionVersion,
                                     size, written, lead_s, sensor));
}

}  // namespace

Result<LockstepResult, Failure> replay_in_lockstep(const settings::Config& config,
                                                   const std::filesystem::path& recording,
                                                   drivers::windlog::PlayerOptions options, double duration_s,
                                                   const std::function<void(double)>& progress, const UseTick& use,
                                                   const std::filesystem::path& states_folder) {
  auto opened = drivers::windlog::Player::open(recording, options, Instant{});
  if (!opened) return opened.error();
  const Nanoseconds begin = opened->position(MonoTime(from_seconds(options.lead_s))).log_time;
  if (!states_folder.empty()) {
    options.playback.start.clear();
    opened = drivers::windlog::Player::open(recording, options, Instant{});
    if (!opened) return opened.error();
  }
  drivers::windlog::Player& player = *opened;
  const std::shared_ptr<const wind::turbulence::GustNoise> gusts = sensing::make_gust_noise(config);
  animation::Animation animation(config, gusts);
  settings::Config one_source = config;
  one_source.sensors.resize(1);
  one_source.wind.fallback.reset();
  const settings::RecordedSource recorded = sensing::recorded_source(recording, options.playback.sensor);
  one_source.sensors[0].blend.unchanged_for_s = recorded.unchanged_for_s / options.rate;
  set_value(one_source.sensors[0], recorded.value);
  wind::blend::BlendedEstimator estimator = sensing::make_estimator(one_source, gusts, animation.reach_m());
  wind::shaping::WindShaping shaping(config.shaping.settings, gusts);
  sensing::SensorJury jury({sensing::jury_rules_of(one_source.sensors[0])}, one_source.wind.stale_intervals,
                           one_source.wind.has_relative_gains);

  std::optional<KeptStates> states;
  if (!states_folder.empty()) {
    auto kept = KeptStates::open(states_folder,
                                 replay_made_of(one_source, recording, options.playback.sensor, options.lead_s), begin);
    if (!kept) return kept.error();
    states = std::move(*kept);
  }

  Ticks ticks(animation, config.animation.rate_hz, options.lead_s, progress, use);
  if (states) ticks.lead_in_until_ended();
  while (ticks.is_leading_in() || (!player.is_finished() && !(duration_s > 0.0 && ticks.now_s() >= duration_s))) {
    // Readings that are due by this tick, at their own time.
    const Instant now{MonoTime(ticks.clock()), UtcTime(ticks.clock())};
    const auto played = player.play(now, [&](const wind::Reading& reading) {
      // As in the daemon: readings that are not believed are left out.
      if (jury.hear(0, reading) != sensing::SensorJury::Verdict::kBelieved) return;
      if (estimator.accept(0, reading)) ticks.add(reading);
    });
    if (!played) return played.error();

    // Opening hours do not apply: log time is not local time.
    wind::ground::DrivingWind wind{estimator.advance(now.mono), estimator.ground(), estimator.stroke()};
    shaping.shape(wind, true);
    const drivers::windlog::PlayerPosition at = player.position(now.mono);
    if (states && ticks.is_leading_in() && now.mono >= MonoTime(from_seconds(options.lead_s)) && at.log_time >= begin) {
      ticks.end_lead_in();
    }
    if (states && ticks.count() < states->first_ticks()) {
      ticks.pass_over();
      if (ticks.count() == states->first_ticks()) {
        if (const auto loaded = states->load(animation, now.mono); !loaded) return loaded.error();
      }
      continue;
    }
    ticks.step(wind, shaping.report().ceiling_gain, at.recorded + at.held_for, seconds(at.length - at.log_time));
    if (states) {
      if (const auto kept = states->keep(animation, ticks.count(), at.log_time, now.mono); !kept) return kept.error();
    }
  }
  return ticks.result();
}

Result<LockstepResult, Failure> replay_in_lockstep(const sensing::RecordedInstallation& installation, double lead_s,
                                                   double duration_s, const std::function<void(double)>& progress,
                                                   const UseTick& use) {
  const settings::Config& config = installation.config;
  const std::shared_ptr<const wind::turbulence::GustNoise> gusts = sensing::make_gust_noise(config);
  animation::Animation animation(config, gusts);
  Ticks ticks(animation, config.animation.rate_hz, lead_s, progress, use);
  const Nanoseconds lead = from_seconds(lead_s);
  sensing::HeldClock clock;
  sensing::SensorHub hub(
      config, clock, gusts, [&ticks](std::size_t, const wind::Reading& reading) { ticks.add(reading); },
      animation.reach_m(), sensing::SensorThread::kOfCaller);
  const std::vector<sensing::NamedPlayer> players = hub.players();
  for (const sensing::NamedPlayer& named : players) named.player->begin_early(lead_s);
  const sensing::PlayerDirector director(config.stream.control, players);
  shaping::WindShaper shaper(config, gusts);
  shaper.keep_site_file(hub.site());
  RecordedClock recorded_clock;

  while (ticks.is_leading_in() || (!hub.is_finished() && !(duration_s > 0.0 && ticks.now_s() >= duration_s))) {
    const Nanoseconds now = ticks.clock();
    clock.hold({.mono = MonoTime(now), .utc = installation.begin - lead + now});
    wind::ground::DrivingWind wind{hub.advance(), hub.ground(), hub.stroke()};
    double left_s = 0.0;
    for (const sensing::NamedPlayer& named : players) {
      const drivers::recording::PlayerReport report = named.player->report();
      if (!report.failure.empty()) return Failure{report.failure, FailureKind::kBadData};
      if (const auto& at = report.position) left_s = std::max(left_s, seconds(at->length - at->log_time));
    }
    const UtcTime recorded = director.recorded_clock().value_or(installation.begin);
    shaper.shape(wind, recorded, hub.is_any_live());
    ticks.step(wind, shaper.status().ceiling_gain, recorded_clock.at(now, recorded), left_s);
  }
  return ticks.result();
}

}  // namespace yuragi::daemon::tools::offline
