#include "engine/wind/view_wind.hpp"

#include <algorithm>
#include <cmath>

namespace yuragi::wind {
namespace {

constexpr double kReached_deg = 0.01;

double within_circle_deg(double angle_deg) {
  const double turned_deg = std::fmod(std::fmod(angle_deg, 360.0) + 360.0, 360.0);
  return std::isfinite(turned_deg) ? turned_deg : 0.0;
}

}  // namespace

ViewWind::ViewWind(double from_deg) noexcept : from_deg_(within_circle_deg(from_deg)) {}

void ViewWind::advance(double dt_s, Vector wind, bool is_live) noexcept {
  if (!(dt_s > 0.0) || !std::isfinite(dt_s)) return;
  const bool is_start = age_s_ < kStart_s;
  if (is_start) age_s_ += dt_s;
  if (!is_live || !std::isfinite(wind.u_m_s) || !std::isfinite(wind.v_m_s)) return;

  const bool is_first = live_s_ == 0.0;
  live_s_ = std::min(live_s_ + dt_s, kMean_s);
  mean_ = mean_ + std::min(1.0, dt_s / live_s_) * (wind - mean_);
  if (speed_of(mean_) < kMinSpeed_m_s) return;

  const double mean_deg = direction_from_deg(mean_);
  if (is_first && is_start) {
    from_deg_ = mean_deg;
    return;
  }
  const double off_deg = std::remainder(mean_deg - from_deg_, 360.0);
  if (std::abs(off_deg) > kDeadBand_deg) is_turning_ = true;
  if (std::abs(off_deg) < kReached_deg) is_turning_ = false;
  if (!is_turning_) return;
  const double most_deg = kMaxTurn_deg_s * dt_s;
  from_deg_ = within_circle_deg(from_deg_ + std::clamp(off_deg, -most_deg, most_deg));
}

}  // namespace yuragi::wind
