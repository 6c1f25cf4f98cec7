#include "engine/wind/reading_judge.hpp"

#include <algorithm>
#include <cmath>

namespace yuragi {
namespace {

constexpr double kRobustDeviations = 5.0;
constexpr double kDeviationPerMad = 1.4826;
/// Below this nothing is told from a calm.
constexpr double kNoWind_m_s = 0.3;
constexpr double kStill_m_s = 0.05;
/// The turbulence that a sensor's steps are compared with, and how much longer a coarse one may repeat itself.
constexpr double kLittleTurbulence = 0.1;
constexpr double kCoarsePatience = 10.0;
constexpr double kDay_s = 86400.0;

template <std::size_t N>
double median(std::array<double, N> values) noexcept {
  const auto middle = values.begin() + N / 2;
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// Without a direction only the speed is compared: as if all came from one side.
WindVector vector_of(const WindReading& reading) noexcept {
  return wind_from(reading.speed_m_s, reading.direction_deg.value_or(0.0));
}

}  // namespace

bool ReadingJudge::judge(const WindReading& reading, std::optional<double> others_m_s) noexcept {
  const double time_s = seconds(reading.time.mono.time_since_epoch());
  if (has_begun_ && time_s < last_s_) return false;
  has_begun_ = true;

  const bool frozen = is_frozen(reading, time_s);
  const bool seized = is_seized(reading, time_s, others_m_s);
  last_s_ = time_s;
  if (frozen || seized) {
    suspicion_.reset();
    believed_ = 0;  // what it said so is no measure for what it will say
    fault_ = frozen ? ReadingFault::kFrozen : ReadingFault::kSeized;
    return false;
  }

  // A spike, or the beginning of a step? What comes next will tell.
  const WindVector wind = vector_of(reading);
  if (is_suspect(wind)) {
    if (!suspicion_ || speed_of(wind - suspicion_->wind) > 0.5 * suspicion_->jump_m_s) {
      if (suspicion_) spikes_ += suspicion_->repeats;
      suspicion_ = {.wind = wind, .since_s = time_s, .jump_m_s = speed_of(wind - middle()), .repeats = 0};
    }
    ++suspicion_->repeats;
    if (!is_confirmed(time_s)) {
      fault_ = ReadingFault::kSpike;
      return false;
    }
    believed_ = 0;  // a new wind: what was before is no measure for it
  } else if (suspicion_) {
    spikes_ += suspicion_->repeats;
  }
  suspicion_.reset();
  believe(wind);
  fault_ = ReadingFault::kNone;
  return true;
}

/// The median of what was believed last, east and north.
WindVector ReadingJudge::middle() const noexcept {
  std::array<double, kWindow> u{};
  std::array<double, kWindow> v{};
  for (std::size_t i = 0; i < kWindow; ++i) {
    u[i] = window_[i].u_m_s;
    v[i] = window_[i].v_m_s;
  }
  return {median(u), median(v)};
}

bool ReadingJudge::is_suspect(WindVector wind) const noexcept {
  if (believed_ < kWindow) return false;
  const WindVector usual = middle();
  std::array<double, kWindow> distances{};
  for (std::size_t i = 0; i < kWindow; ++i) distances[i] = speed_of(window_[i] - usual);
  const double allowed_m_s = std::max(kRobustDeviations * kDeviationPerMad * median(distances),
                                      settings_.least_spike_m_s + 0.5 * speed_of(usual));
  return speed_of(wind - usual) > allowed_m_s;
}

/// Has the step been there for as long as the wind would take to make it, and been said more than once?
bool ReadingJudge::is_confirmed(double time_s) const noexcept {
  const double needed_s = suspicion_->jump_m_s / settings_.slew_m_s2;
  return suspicion_->repeats >= 2 && time_s - suspicion_->since_s >= needed_s;
}

void ReadingJudge::believe(WindVector wind) noexcept {
  window_[believed_ % kWindow] = wind;
  ++believed_;
}

bool ReadingJudge::is_frozen(const WindReading& reading, double time_s) noexcept {
  const bool is_same = same_ && reading.speed_m_s == same_->speed_m_s && reading.direction_deg == same_->direction_deg;
  if (!is_same) {
    const double step_m_s = same_ ? std::abs(reading.speed_m_s - same_->speed_m_s) : 0.0;
    if (step_m_s > 0.0) resolution_m_s_ = resolution_m_s_ > 0.0 ? std::min(resolution_m_s_, step_m_s) : step_m_s;
    same_ = reading;
    same_since_s_ = time_s;
    same_count_ = 1;
    return false;
  }
  ++same_count_;
  if (reading.speed_m_s < kNoWind_m_s) return false;

  // Steps as large as the turbulence: the same number for a while is no wonder.
  const bool is_coarse = resolution_m_s_ > kLittleTurbulence * reading.speed_m_s;
  const double patience = is_coarse ? kCoarsePatience : 1.0;
  return static_cast<double>(same_count_) >= patience * static_cast<double>(settings_.frozen_readings) &&
         time_s - same_since_s_ >= patience * settings_.frozen_s;
}

bool ReadingJudge::is_seized(const WindReading& reading, double time_s, std::optional<double> others_m_s) noexcept {
  if (reading.speed_m_s > kStill_m_s) {
    const double part = usual_m_s_ > 0.0 ? -std::expm1(-(time_s - last_s_) / kDay_s) : 1.0;
    usual_m_s_ += part * (reading.speed_m_s - usual_m_s_);
    calm_since_s_.reset();
    return false;
  }
  if (!calm_since_s_) calm_since_s_ = time_s;
  const double patience_s = others_m_s ? settings_.seized_s : settings_.seized_alone_s;
  return time_s - *calm_since_s_ >= patience_s && others_m_s.value_or(usual_m_s_) > settings_.windy_m_s;
}

}  // namespace yuragi
