#include "daemon/tools/report/default_wind.hpp"

#include <algorithm>
#include <cmath>

#include "daemon/tools/report/gust_means.hpp"
#include "engine/wind/turbulence/von_karman_integrals.hpp"

namespace yuragi::daemon::tools::report {
namespace {

// The ranges of the keys of [wind].
constexpr double kMaxSpeed_m_s = 40.0;
constexpr double kMinLength_m = 1.0;
constexpr double kMaxLength_m = 1000.0;
constexpr double kMaxIntensity = 1.0;

/// The intensity of the whole spectrum that has `block_intensity` in blocks of 10 minutes.
double whole_intensity(double block_intensity, double length_m, double speed_m_s) {
  const double in_mean = wind::turbulence::von_karman_mean_variance(TenMinuteBlocks::kBlock_s * speed_m_s / length_m);
  return block_intensity / std::sqrt(1.0 - in_mean);
}

}  // namespace

std::optional<DefaultWind> default_wind(const SensorNumbers& sensor) {
  if (!sensor.spectrum || !sensor.spectrum->von_karman || !(sensor.mean_m_s > 0.0)) return std::nullopt;
  const VonKarmanFit& fit = *sensor.spectrum->von_karman;
  DefaultWind wind{.speed_m_s = std::min(sensor.mean_m_s, kMaxSpeed_m_s),
                   .direction_deg = sensor.direction_deg,
                   .turbulence_intensity = fit.intensity,
                   .length_m = std::clamp(fit.length_m.value_or(sensor.assumed_length_m), kMinLength_m, kMaxLength_m),
                   .is_length_measured = fit.length_m.has_value()};
  if (const auto& measured = sensor.blocks.turbulence_intensity) {
    wind.turbulence_intensity = whole_intensity(*measured, wind.length_m, wind.speed_m_s);
    // Long gusts of more than the largest intensity: shorter ones have more of it within 10 minutes.
    while (wind.turbulence_intensity > kMaxIntensity && *measured < kMaxIntensity && wind.length_m > kMinLength_m) {
      wind.length_m = std::max(0.9 * wind.length_m, kMinLength_m);
      wind.turbulence_intensity = whole_intensity(*measured, wind.length_m, wind.speed_m_s);
    }
  }
  wind.turbulence_intensity = std::min(wind.turbulence_intensity, kMaxIntensity);
  return wind;
}

}  // namespace yuragi::daemon::tools::report
