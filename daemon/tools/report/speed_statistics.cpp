#include "daemon/tools/report/speed_statistics.hpp"

#include <algorithm>
#include <cmath>

namespace yuragi::daemon::tools::report {

void SpeedHistogram::add(double speed_m_s) {
  // A speed with one decimal is on an edge, and belongs to the class above.
  const double place = std::floor(speed_m_s * kClasses_per_m_s + 1e-6);
  ++counts_[static_cast<std::size_t>(std::clamp(place, 0.0, static_cast<double>(kClasses - 1)))];
  ++count_;
}

double SpeedHistogram::percentile_m_s(double part) const {
  const double wanted = part * static_cast<double>(count_);
  double below = 0.0;
  for (std::size_t i = 0; i < kClasses; ++i) {
    const auto here = static_cast<double>(counts_[i]);
    if (here > 0.0 && below + here >= wanted) {
      return (static_cast<double>(i) + (wanted - below) / here) / kClasses_per_m_s;
    }
    below += here;
  }
  return 0.0;
}

std::vector<double> SpeedHistogram::shares(std::size_t fine) const {
  std::vector<double> shares((kClasses + fine - 1) / fine);
  for (std::size_t i = 0; i < kClasses; ++i) {
    shares[i / fine] += static_cast<double>(counts_[i]) / static_cast<double>(std::max<std::uint64_t>(count_, 1));
  }
  while (!shares.empty() && shares.back() == 0.0) shares.pop_back();
  return shares;
}

void SpeedStatistics::add(double speed_m_s, std::size_t hour) {
  all_.add(speed_m_s);
  by_hour_[hour].add(speed_m_s);
  hour_sum_m_s_[hour] += speed_m_s;
  const double distance = speed_m_s - mean_m_s_;  // Welford's method: accurate for a small variance with a large mean
  mean_m_s_ += distance / static_cast<double>(all_.count());
  squares_m2_s2_ += distance * (speed_m_s - mean_m_s_);
}

double SpeedStatistics::deviation_m_s() const {
  return all_.count() == 0 ? 0.0 : std::sqrt(squares_m2_s2_ / static_cast<double>(all_.count()));
}

SpeedDistribution SpeedStatistics::distribution() const {
  SpeedDistribution result;
  result.share = all_.shares(5);
  result.p10_m_s = all_.percentile_m_s(0.10);
  result.p50_m_s = all_.percentile_m_s(0.50);
  result.p90_m_s = all_.percentile_m_s(0.90);
  result.p99_m_s = all_.percentile_m_s(0.99);
  // Justus et al. 1978 give it for shapes from 1 to 10; not for a steadier wind.
  const double variation = mean_m_s_ > 0.0 ? deviation_m_s() / mean_m_s_ : 0.0;
  if (variation > 0.1 && variation < 1.2) {
    result.weibull_shape = std::pow(variation, -1.086);
    result.weibull_scale_m_s = mean_m_s_ / std::tgamma(1.0 + 1.0 / *result.weibull_shape);
  }
  return result;
}

std::array<HourOfDay, 24> SpeedStatistics::hours() const {
  std::array<HourOfDay, 24> hours;
  for (std::size_t hour = 0; hour < hours.size(); ++hour) {
    const SpeedHistogram& speeds = by_hour_[hour];
    if (speeds.count() == 0) continue;
    hours[hour] = {.count = speeds.count(),
                   .mean_m_s = hour_sum_m_s_[hour] / static_cast<double>(speeds.count()),
                   .p10_m_s = speeds.percentile_m_s(0.1),
                   .p90_m_s = speeds.percentile_m_s(0.9)};
  }
  return hours;
}

void RoseTally::add(double speed_m_s, double direction_deg) {
  ++count_;
  if (speed_m_s < kRoseCalm_m_s) {
    ++calm_;
    return;
  }
  constexpr double kWidth_deg = 360.0 / kRoseSectors;
  const auto sector = static_cast<std::size_t>(std::floor(direction_deg / kWidth_deg + 0.5)) % kRoseSectors;
  const auto fine = static_cast<std::size_t>(std::min(speed_m_s, static_cast<double>(kFineClasses - 1)));
  ++counts_[sector][fine];
  strongest_ = std::max(strongest_, fine);
}

WindRose RoseTally::finish() const {
  WindRose rose;
  rose.count = count_;
  if (count_ == 0) return rose;
  // The narrowest round width with which the strongest wind is in the last class.
  std::size_t width_m_s = kFineClasses / kRoseClasses;
  for (const std::size_t round : {1U, 2U, 3U, 4U, 5U, 6U, 8U, 10U, 15U}) {
    if (strongest_ >= round * kRoseClasses) continue;
    width_m_s = round;
    break;
  }
  rose.class_m_s = static_cast<double>(width_m_s);
  const auto all = static_cast<double>(count_);
  rose.calm_share = static_cast<double>(calm_) / all;
  for (std::size_t sector = 0; sector < kRoseSectors; ++sector) {
    std::array<std::uint64_t, kRoseClasses> counts{};
    for (std::size_t fine = 0; fine < kFineClasses; ++fine) {
      counts[std::min(fine / width_m_s, kRoseClasses - 1)] += counts_[sector][fine];
    }
    for (std::size_t speed = 0; speed < kRoseClasses; ++speed) {
      rose.share[sector][speed] = static_cast<double>(counts[speed]) / all;
    }
  }
  return rose;
}

}  // namespace yuragi::daemon::tools::report
