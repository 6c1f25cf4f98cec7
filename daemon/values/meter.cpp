#include "daemon/values/meter.hpp"

#include <algorithm>
#include <cmath>

#include "engine/wind/wind_vector.hpp"

namespace yuragi::daemon::values {
namespace {

/// Until gusts have been measured for a while, their deviation is taken as this share of the mean speed.
constexpr double kUsualIntensity = 0.2;
constexpr double kUsualFor_s = 10.0;
constexpr double kMinDeviation_m_s = 0.05;
/// Below this speed the direction is kept.
constexpr double kMinDirected_m_s = 0.05;

}  // namespace

double NormScale::norm_of(double speed_m_s) const noexcept {
  if (!(median_m_s > 0.0)) return 0.0;
  if (speed_m_s <= median_m_s) return 0.5 * speed_m_s / median_m_s;
  const double above_m_s = strong_m_s - median_m_s;
  if (!(above_m_s > 0.0)) return 1.0;
  return std::min(0.5 + 0.5 * (speed_m_s - median_m_s) / above_m_s, 1.0);
}

void Meter::add(wind::Vector wind, double live, double age_s, double dt_s, const NormScale& scale) noexcept {
  const double step_s = std::clamp(std::isfinite(dt_s) ? dt_s : 0.0, 0.0, 1.0);
  if (!std::isfinite(wind.u_m_s) || !std::isfinite(wind.v_m_s)) return;
  const double speed_m_s = wind::speed_of(wind);
  const double before_m_s = second_ == 0 && speeds_[0].time_s == 0.0 ? speed_m_s : mean_m_s();
  speeds_[second_ % kMean_s].add(speed_m_s, step_s);
  squares_[second_ % kGusts_s].add((speed_m_s - before_m_s) * (speed_m_s - before_m_s), step_s);
  double& strongest_m_s = strongest_m_s_[second_ % kGusts_s];
  if (const auto gust_m_s = gust_.add(speed_m_s, step_s)) strongest_m_s = std::max(strongest_m_s, *gust_m_s);
  since_second_s_ += step_s;
  for (; since_second_s_ >= 1.0; since_second_s_ -= 1.0) turn_second();

  const double mean = mean_m_s();
  const double gust_m_s = speed_m_s - mean;
  const auto set = [this](Quantity quantity, double value) { readout_[quantity] = value; };
  set(Quantity::kSpeed, speed_m_s);
  if (speed_m_s >= kMinDirected_m_s) set(Quantity::kDirection, wind::direction_from_deg(wind));
  set(Quantity::kU, wind.u_m_s);
  set(Quantity::kV, wind.v_m_s);
  set(Quantity::kMean, mean);
  set(Quantity::kGust, gust_m_s);
  set(Quantity::kPeak, std::max(peak_m_s_, strongest_m_s_[second_ % kGusts_s]));
  set(Quantity::kNorm, scale.norm_of(speed_m_s));
  set(Quantity::kGustNorm, std::clamp(gust_m_s / (2.0 * gust_deviation_m_s(mean)), 0.0, 1.0));
  set(Quantity::kLive, std::clamp(live, 0.0, 1.0));
  set(Quantity::kAge, live > 0.0 ? std::max(age_s, 0.0) : readout_[Quantity::kAge] + step_s);
}

void Meter::turn_second() noexcept {
  const auto move_on = [this](auto& ring, TimeSum& all) {
    const TimeSum& over = ring[second_ % ring.size()];
    all.value += over.value;
    all.time_s += over.time_s;
    TimeSum& next = ring[(second_ + 1) % ring.size()];
    all.value -= next.value;
    all.time_s -= next.time_s;
    next = {};
    // Rounding errors do not grow over months.
    if ((second_ + 1) % ring.size() != 0) return;
    all = {};
    for (const TimeSum& kept : ring) {
      all.value += kept.value;
      all.time_s += kept.time_s;
    }
  };
  move_on(speeds_, all_speeds_);
  move_on(squares_, all_squares_);
  ++second_;
  strongest_m_s_[second_ % kGusts_s] = 0.0;
  peak_m_s_ = *std::ranges::max_element(strongest_m_s_);
}

double Meter::mean_m_s() const noexcept {
  const TimeSum& present = speeds_[second_ % kMean_s];
  const double time_s = all_speeds_.time_s + present.time_s;
  return time_s > 0.0 ? (all_speeds_.value + present.value) / time_s : 0.0;
}

double Meter::gust_deviation_m_s(double mean_m_s) const noexcept {
  const TimeSum& present = squares_[second_ % kGusts_s];
  const double usual_m_s = kUsualIntensity * mean_m_s;
  const double value = all_squares_.value + present.value + kUsualFor_s * usual_m_s * usual_m_s;
  const double deviation_m_s = std::sqrt(std::max(value, 0.0) / (all_squares_.time_s + present.time_s + kUsualFor_s));
  return std::max(deviation_m_s, kMinDeviation_m_s);
}

}  // namespace yuragi::daemon::values
