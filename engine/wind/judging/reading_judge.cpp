#include "engine/wind/judging/reading_judge.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace yuragi::wind::judging {
namespace {

constexpr double kRobustDeviations = 5.0;
constexpr double kDeviationPerMad = 1.4826;
/// A sensor with random values has a large deviation, too: beyond this many times the minimum spike every reading is
/// suspect.
constexpr double kMaxPerMin = 2.0;
/// A step that was repeated this often is accepted, however fast: recordings can be played at a hundred times the
/// speed.
constexpr std::size_t kEnoughRepeats = 20;
/// Older readings are not compared with new ones.
constexpr double kForgotten_s = 600.0;
/// The number of readings for the share of bad ones, and the shares at which a sensor is rejected and accepted again.
constexpr double kReadingsCounted = 20.0;
constexpr double kGiveUpShare = 0.3;
constexpr double kTrustShare = 0.05;
/// Below this a wind cannot be distinguished from a calm.
constexpr double kNoWind_m_s = 0.3;
constexpr double kStill_m_s = 0.05;
/// The turbulence that a sensor's steps are compared with, and how much longer a coarse one may repeat itself.
constexpr double kLittleTurbulence = 0.05;
constexpr double kCoarsePatience = 10.0;
/// The factor on its usual time of repetition; and for a sensor that has never sent another value.
constexpr double kRepeatingPatience = 10.0;
constexpr double kNeverMovedPatience = 20.0;
constexpr double kRunsRemembered = 16.0;
/// A gap between two readings counts as a calm of at most this length.
constexpr double kMaxStep_s = 600.0;
constexpr double kDay_s = 86400.0;

template <std::size_t N>
double median(std::array<double, N> values) noexcept {
  const auto middle = values.begin() + N / 2;
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// Without a direction only the speed is compared: as if all winds had one direction.
Vector vector_of(const Reading& reading) noexcept {
  return wind_from(reading.speed_m_s, reading.direction_deg.value_or(0.0));
}

}  // namespace

bool ReadingJudge::judge(const Reading& reading, std::optional<double> others_m_s) noexcept {
  const double time_s = seconds(reading.time.mono.time_since_epoch());
  if (has_begun_ && time_s < last_s_) return false;
  if (!has_begun_) last_s_ = time_s;
  has_begun_ = true;
  if (time_s - last_s_ > kForgotten_s) {
    believed_ = 0;
    same_.reset();
  }

  fault_ = fault_of(reading, time_s, others_m_s);
  last_s_ = time_s;
  return fault_ == ReadingFault::kNone;
}

void ReadingJudge::count_impossible(std::uint64_t readings) noexcept {
  // More readings than the memory spans have no further effect.
  const auto counted = std::min(static_cast<double>(readings), 10.0 * kReadingsCounted);
  for (double i = 0.0; i < counted; ++i) count(true);
  if (is_implausible_ && fault_ <= ReadingFault::kImplausible) fault_ = ReadingFault::kImplausible;
}

void ReadingJudge::recalibrate(const Reading& before, const Reading& after) noexcept {
  believed_ = 0;
  suspicion_.reset();
  if (fault_ == ReadingFault::kSpike) fault_ = ReadingFault::kNone;
  if (same_ && has_same_values(*same_, before)) same_ = after;
  if (!(before.speed_m_s > 0.0) || !(after.speed_m_s > 0.0)) return;
  const double factor = after.speed_m_s / before.speed_m_s;
  resolution_m_s_ *= factor;
  usual_m_s_ *= factor;
}

ReadingFault ReadingJudge::fault_of(const Reading& reading, double time_s, std::optional<double> others_m_s) noexcept {
  const bool is_out_of_range = reading.speed_m_s > settings_.max_speed_m_s;
  const bool is_repeated = check_frozen(reading, time_s);
  const bool is_dead = check_seized(reading.speed_m_s, time_s, others_m_s);
  if (is_out_of_range || is_repeated || is_dead) {
    dismiss_suspicion();
    believed_ = 0;  // old readings are no measure for new ones
    if (is_out_of_range) count(true);
    if (is_repeated) return ReadingFault::kFrozen;
    if (is_dead) return ReadingFault::kSeized;
    return is_implausible_ ? ReadingFault::kImplausible : ReadingFault::kSpike;
  }

  const Vector wind = vector_of(reading);
  const bool is_held_back = check_spike(wind, time_s);
  if (!is_held_back) {
    believe(wind);
    count(false);
  }
  if (is_implausible_) return ReadingFault::kImplausible;
  return is_held_back ? ReadingFault::kSpike : ReadingFault::kNone;
}

/// A spike, or the beginning of a step? The next readings decide.
bool ReadingJudge::check_spike(Vector wind, double time_s) noexcept {
  if (!is_suspect(wind)) {
    dismiss_suspicion();
    return false;
  }
  if (!suspicion_ || speed_of(wind - suspicion_->wind) > 0.5 * suspicion_->jump_m_s) {
    dismiss_suspicion();
    suspicion_ = {.wind = wind, .since_s = time_s, .jump_m_s = speed_of(wind - middle()), .repeats = 0};
  }
  ++suspicion_->repeats;
  if (!is_confirmed(time_s)) return true;
  suspicion_.reset();
  believed_ = 0;  // a new wind: the readings before are no measure for it
  return false;
}

/// The suspect was a spike.
void ReadingJudge::dismiss_suspicion() noexcept {
  if (!suspicion_) return;
  spikes_ += suspicion_->repeats;
  for (std::size_t i = 0; i < suspicion_->repeats; ++i) count(true);
  suspicion_.reset();
}

/// The median of the last accepted readings, east and north.
Vector ReadingJudge::middle() const noexcept {
  std::array<double, kWindow> u{};
  std::array<double, kWindow> v{};
  for (std::size_t i = 0; i < kWindow; ++i) {
    u[i] = window_[i].u_m_s;
    v[i] = window_[i].v_m_s;
  }
  return {median(u), median(v)};
}

bool ReadingJudge::is_suspect(Vector wind) const noexcept {
  if (believed_ < kWindow) return false;
  const Vector usual = middle();
  std::array<double, kWindow> distances{};
  for (std::size_t i = 0; i < kWindow; ++i) distances[i] = speed_of(window_[i] - usual);
  const double least_m_s = settings_.least_spike_m_s + 0.5 * speed_of(usual);
  const double allowed_m_s =
      std::clamp(kRobustDeviations * kDeviationPerMad * median(distances), least_m_s, kMaxPerMin * least_m_s);
  return speed_of(wind - usual) > allowed_m_s;
}

/// Returns true if the step has lasted for as long as the wind needs for it, and was repeated.
bool ReadingJudge::is_confirmed(double time_s) const noexcept {
  const double needed_s = suspicion_->jump_m_s / settings_.slew_m_s2;
  return suspicion_->repeats >= kEnoughRepeats ||
         (suspicion_->repeats >= 2 && time_s - suspicion_->since_s >= needed_s);
}

void ReadingJudge::believe(Vector wind) noexcept {
  window_[believed_ % kWindow] = wind;
  ++believed_;
}

void ReadingJudge::count(bool is_bad) noexcept {
  bad_share_ += ((is_bad ? 1.0 : 0.0) - bad_share_) / kReadingsCounted;
  is_implausible_ = bad_share_ > (is_implausible_ ? kTrustShare : kGiveUpShare);
}

bool ReadingJudge::check_frozen(const Reading& reading, double time_s) noexcept {
  if (!same_ || !has_same_values(reading, *same_)) {
    if (same_) {
      const double step_m_s = std::abs(reading.speed_m_s - same_->speed_m_s);
      if (step_m_s > 0.0) resolution_m_s_ = resolution_m_s_ > 0.0 ? std::min(resolution_m_s_, step_m_s) : step_m_s;
      // How long it usually repeats a value. A calm carries no information on that, and a freeze little.
      const double run_s = std::min(time_s - same_since_s_, frozen_patience() * settings_.frozen_s);
      if (!usual_run_s_) usual_run_s_ = std::min(run_s, settings_.frozen_s);
      if (same_->speed_m_s >= kNoWind_m_s) *usual_run_s_ += (run_s - *usual_run_s_) / kRunsRemembered;
    }
    same_ = reading;
    same_since_s_ = time_s;
    same_count_ = 1;
    return false;
  }
  ++same_count_;
  if (reading.speed_m_s < kNoWind_m_s) return false;
  const double patience = frozen_patience();
  const double longest_s = std::max(patience * settings_.frozen_s, kRepeatingPatience * usual_run_s_.value_or(0.0));
  return static_cast<double>(same_count_) >= patience * static_cast<double>(settings_.frozen_readings) &&
         time_s - same_since_s_ >= longest_s;
}

/// The factor on this sensor's usual time of repetition.
double ReadingJudge::frozen_patience() const noexcept {
  if (!usual_run_s_) return kNeverMovedPatience;
  // A resolution as coarse as the turbulence normally repeats numbers.
  const bool is_coarse = same_ && resolution_m_s_ > kLittleTurbulence * same_->speed_m_s;
  return is_coarse ? kCoarsePatience : 1.0;
}

bool ReadingJudge::check_seized(double speed_m_s, double time_s, std::optional<double> others_m_s) noexcept {
  const double passed_s = time_s - last_s_;
  if (speed_m_s > kStill_m_s) {
    const double part = usual_m_s_ > 0.0 ? -std::expm1(-passed_s / kDay_s) : 1.0;
    usual_m_s_ += part * (speed_m_s - usual_m_s_);
    is_still_ = is_seized_ = false;
    still_s_ = windy_still_s_ = 0.0;
    return false;
  }
  const bool others_are_windy = others_m_s && *others_m_s > settings_.windy_m_s;
  const double step_s = std::exchange(is_still_, true) ? std::min(passed_s, kMaxStep_s) : 0.0;
  still_s_ += step_s;
  if (others_are_windy) windy_still_s_ += step_s;
  // Until it moves: a calm of the other sensors does not clear it.
  is_seized_ = is_seized_ || (others_m_s ? others_are_windy && windy_still_s_ >= settings_.seized_s
                                         : usual_m_s_ > settings_.windy_m_s && still_s_ >= settings_.seized_alone_s);
  return is_seized_;
}

}  // namespace yuragi::wind::judging
