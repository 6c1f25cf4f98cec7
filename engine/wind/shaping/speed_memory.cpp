#include "engine/wind/shaping/speed_memory.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "engine/math/portable.hpp"

namespace yuragi::wind::shaping {
namespace {

constexpr double kSlowest_m_s = 0.05;
constexpr double kBinsPerOctave = 8.0;

/// Where a bin begins.
double edge_m_s(double bin) noexcept {
  return kSlowest_m_s * math::power_of_two(bin / kBinsPerOctave);
}

std::size_t bin_of(double speed_m_s) noexcept {
  const double bin = kBinsPerOctave * std::log2(std::max(speed_m_s, kSlowest_m_s) / kSlowest_m_s);
  return static_cast<std::size_t>(std::clamp(bin, 0.0, static_cast<double>(SpeedMemory::kBins - 1)));
}

}  // namespace

void SpeedMemory::change_memory(double memory_s) noexcept {
  memory_s_ = memory_s;
  const double known_s = this->known_s();
  if (known_s <= memory_s) return;
  for (double& time_s : times_s_) time_s *= memory_s / known_s;
}

void SpeedMemory::add(double speed_m_s, double dt_s) noexcept {
  if (!(dt_s > 0.0)) return;
  const double kept = std::exp(-dt_s / memory_s_);
  for (double& time_s : times_s_) time_s *= kept;
  times_s_[bin_of(speed_m_s)] += memory_s_ * (1.0 - kept);
}

double SpeedMemory::percentile(double share) const noexcept {
  const double wanted_s = std::clamp(share, 0.0, 1.0) * known_s();
  double before_s = 0.0;
  for (std::size_t bin = 0; bin < kBins; ++bin) {
    const double time_s = times_s_[bin];
    if (time_s > 0.0 && before_s + time_s >= wanted_s) {
      return edge_m_s(static_cast<double>(bin) + (wanted_s - before_s) / time_s);
    }
    before_s += time_s;
  }
  return 0.0;
}

double SpeedMemory::known_s() const noexcept {
  return std::accumulate(times_s_.begin(), times_s_.end(), 0.0);
}

bool SpeedMemory::restore(std::span<const double> times_s) noexcept {
  if (times_s.size() != kBins) return false;
  constexpr double kLongest_s = 1e12;
  double sum_s = 0.0;
  for (const double time_s : times_s) {
    if (!(time_s >= 0.0 && time_s <= kLongest_s)) return false;
    sum_s += time_s;
  }
  const double scale = sum_s > memory_s_ ? memory_s_ / sum_s : 1.0;
  std::ranges::transform(times_s, times_s_.begin(), [scale](double time_s) { return scale * time_s; });
  return true;
}

}  // namespace yuragi::wind::shaping
