#include "tests/proof/estimated_wind.hpp"

#include <algorithm>
#include <cmath>

namespace yuragi::proof {
namespace {

constexpr double kEstimateTick_s = 1.0 / 60.0;

}  // namespace

std::shared_ptr<const wind::turbulence::GustNoise> shared_noise() {
  static const auto noise = std::make_shared<const wind::turbulence::GustNoise>(wind::turbulence::GustNoiseSettings{});
  return noise;
}

std::vector<wind::Vector> wind_of(EstimatedWind& estimated, const std::vector<wind::Reading>& readings, double from_s,
                                  double to_s) {
  std::vector<wind::Vector> winds;
  const MonoTime from(from_seconds(from_s));
  auto next =
      std::ranges::lower_bound(readings, from, {}, [](const wind::Reading& reading) { return reading.time.mono; });
  const auto ticks = static_cast<int>(std::lround((to_s - from_s) / kEstimateTick_s));
  for (int tick = 0; tick < ticks; ++tick) {
    const MonoTime now = from + from_seconds(tick * kEstimateTick_s);
    for (; next != readings.end() && next->time.mono <= now; ++next) estimated.take(*next);
    winds.push_back(estimated.advance(now));
  }
  return winds;
}

}  // namespace yuragi::proof
