#include "engine/wind/turbulence/wind_turbulence.hpp"

#include <algorithm>

namespace yuragi::wind::turbulence {
namespace {

constexpr double kLargestDifference = 1.0;

TurbulencePrior across_the_wind(TurbulencePrior prior) {
  prior.intensity *= kAcrossPerAlong;
  return prior;
}

}  // namespace

WindTurbulence::WindTurbulence(const TurbulencePrior& prior, double memory_s)
    : along_(prior, memory_s),
      across_(across_the_wind(prior), memory_s),
      history_(std::size_t{2} << (TurbulenceFit::kScales - 1)) {}

void WindTurbulence::forget(double dt_s) noexcept {
  along_.forget(dt_s);
  across_.forget(dt_s);
}

void WindTurbulence::take(WindVector wind, WindVector ahead, double speed_m_s, bool has_across) noexcept {
  const std::size_t size = history_.size();
  history_[next_] = wind;
  next_ = (next_ + 1) % size;
  history_size_ = std::min(history_size_ + 1, size);

  const auto reading = [&](std::size_t back) { return history_[(next_ + size - 1 - back) % size]; };
  const auto limited = [](double part) { return std::clamp(part, -kLargestDifference, kLargestDifference); };
  WindVector newer{};  // the sum of the last 2^s readings
  std::size_t summed = 0;
  for (std::size_t scale = 0; scale < TurbulenceFit::kScales; ++scale) {
    const std::size_t count = std::size_t{1} << scale;
    if (history_size_ < 2 * count) return;
    for (; summed < count; ++summed) newer = newer + reading(summed);
    WindVector older{};
    for (std::size_t back = count; back < 2 * count; ++back) older = older + reading(back);
    const WindVector difference = 1.0 / (static_cast<double>(count) * speed_m_s) * (newer - older);
    along_.add(scale, limited(difference.u_m_s * ahead.u_m_s + difference.v_m_s * ahead.v_m_s), speed_m_s);
    if (!has_across) continue;
    across_.add(scale, limited(difference.v_m_s * ahead.u_m_s - difference.u_m_s * ahead.v_m_s), speed_m_s);
  }
}

void WindTurbulence::fit(double interval_s, double speed_m_s) noexcept {
  along_.fit(interval_s, speed_m_s);
  across_.fit(interval_s, speed_m_s);
}

}  // namespace yuragi::wind::turbulence
