#include "daemon/tools/offline/lockstep_replay.hpp"

#include <algorithm>

#include "daemon/animation/animation.hpp"
#include "daemon/sensing/sensor_hub.hpp"
#include "engine/pose/pose_hash.hpp"

namespace yuragi::daemon::tools::offline {
namespace {

std::uint64_t hash_poses(std::uint64_t hash, std::span<const pose::Pose* const> poses) {
  for (const pose::Pose* pose : poses) hash = pose::pose_hash(hash, *pose);
  return hash;
}

}  // namespace

Result<LockstepResult, Failure> replay_in_lockstep(const settings::Config& config,
                                                   const std::filesystem::path& recording,
                                                   const drivers::windlog::PlayerOptions& options, double duration_s,
                                                   const std::function<void(double)>& progress, const UseTick& use) {
  auto opened = drivers::windlog::WindlogPlayer::open(recording, options, Instant{});
  if (!opened) return opened.error();
  drivers::windlog::WindlogPlayer& player = *opened;
  const std::shared_ptr<const wind::turbulence::GustNoise> gusts = sensing::make_gust_noise(config);
  animation::Animation animation(config, gusts);
  settings::Config one_source = config;
  one_source.sensors.resize(1);
  one_source.wind.fallback.reset();
  wind::blend::BlendedEstimator estimator = sensing::make_estimator(one_source, gusts, animation.reach_m());
  wind::shaping::WindShaping shaping(config.shaping.settings, gusts);

  const double rate_hz = config.animation.rate_hz;
  const auto ticks_between_progress = static_cast<std::uint64_t>(60.0 * rate_hz);
  LockstepResult result;
  std::uint64_t followed_ticks = 0;
  const std::optional<wind::judging::JudgeSettings>& judged_by = one_source.sensors[0].judge;
  wind::judging::ReadingJudge judge(judged_by.value_or(wind::judging::JudgeSettings{}));

  for (std::uint64_t tick = 0; !player.is_finished(); ++tick) {
    const double now_s = static_cast<double>(tick) / rate_hz;
    if (duration_s > 0.0 && now_s >= duration_s) break;

    // Readings that are due by this tick, at their own log time.
    const Instant now{MonoTime(from_seconds(now_s)), UtcTime(from_seconds(now_s))};
    const auto played = player.play(now, [&](const wind::WindReading& reading) {
      // As in the daemon: readings that are not believed are left out.
      if (judged_by && reading.quality != wind::ReadingQuality::kSimulated && !judge.judge(reading)) return;
      if (!estimator.accept(0, reading)) return;
      ++result.readings;
      result.reading_mean_m_s += reading.speed_m_s;
      result.reading_max_m_s = std::max(result.reading_max_m_s, reading.speed_m_s);
    });
    if (!played) return played.error();

    // Opening hours do not apply: log time is not local time.
    wind::ground::DrivingWind wind{estimator.advance(MonoTime(from_seconds(now_s))), estimator.ground(),
                                   estimator.stroke()};
    shaping.shape(wind, true);
    const wind::WindState& state = wind.state;
    animation.step(wind, 1.0 / rate_hz);
    result.pose_hash = hash_poses(result.pose_hash, animation.poses());
    if (use) use(now_s, animation);
    ++result.ticks;
    if (state.source == wind::WindSource::kLive) {
      const double speed_m_s = speed_of(state.wind);
      ++followed_ticks;
      result.wind_mean_m_s += speed_m_s;
      result.wind_max_m_s = std::max(result.wind_max_m_s, speed_m_s);
    }
    if (progress && tick % ticks_between_progress == 0) progress(now_s);
  }

  result.log_duration_s = static_cast<double>(result.ticks) / rate_hz;
  if (result.readings > 0) result.reading_mean_m_s /= static_cast<double>(result.readings);
  if (followed_ticks > 0) result.wind_mean_m_s /= static_cast<double>(followed_ticks);
  return result;
}

}  // namespace yuragi::daemon::tools::offline
