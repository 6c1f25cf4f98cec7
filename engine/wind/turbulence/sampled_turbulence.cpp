#include "engine/wind/turbulence/sampled_turbulence.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "engine/math/portable.hpp"
#include "engine/noise/von_karman_corner.hpp"
#include "engine/wind/turbulence/ratio_table.hpp"
#include "engine/wind/turbulence/von_karman.hpp"
#include "engine/wind/turbulence/von_karman_integrals.hpp"

namespace yuragi::wind::turbulence {
namespace {

/// Above this number of samples means equal those over continuous time.
constexpr std::size_t kSampledScales = 6;
constexpr double kGammaOfThird = 2.6789385347077476;

/// The autocorrelation at a lag over L / U: the transform of W5. Von Karman 1948; as in ESDU 85020. Across the wind it
/// is f + (r / 2) df/dr, f being that along it (incompressible turbulence, carried along frozen).
double autocorrelation(double lag, WindComponent component) {
  const double x = lag / noise::kVonKarmanCorner;
  if (x < 1e-9) return 1.0;
  if (x > 600.0) return 0.0;
  const double scale = math::cube_root(4.0) / kGammaOfThird * math::cube_root(x);
  const double along = scale * std::cyl_bessel_k(1.0 / 3.0, x);
  if (component == WindComponent::kAlong) return along;
  return along - 0.5 * x * scale * std::cyl_bessel_k(2.0 / 3.0, x);
}

double sampled_haar(std::size_t scale, double ratio, WindComponent component) {
  const std::size_t count = std::size_t{1} << scale;
  std::vector<double> at(2 * count);
  for (std::size_t lag = 0; lag < at.size(); ++lag) {
    at[lag] = autocorrelation(ratio * static_cast<double>(lag), component);
  }
  // The sum for each mean with itself, minus that for one with the other: pairs of samples at each distance, in either
  // direction.
  double sum = static_cast<double>(count) * (at[0] - at[count]);
  for (std::size_t lag = 1; lag < count; ++lag) {
    sum += static_cast<double>(count - lag) * (2.0 * at[lag] - at[count - lag] - at[count + lag]);
  }
  return 2.0 * sum / (static_cast<double>(count) * static_cast<double>(count));
}

/// Returns a table for each scale.
const std::vector<RatioTable>& sampled_haar_tables(WindComponent component) {
  static const auto kMade = [](WindComponent of) {
    std::vector<RatioTable> tables;
    for (std::size_t scale = 0; scale < kSampledScales; ++scale) {
      tables.emplace_back([scale, of](double ratio) { return sampled_haar(scale, ratio, of); });
    }
    return tables;
  };
  static const std::vector<RatioTable> kAlong = kMade(WindComponent::kAlong);
  static const std::vector<RatioTable> kAcross = kMade(WindComponent::kAcross);
  return component == WindComponent::kAlong ? kAlong : kAcross;
}

}  // namespace

void make_sampled_haar_table() {
  sampled_haar_tables(WindComponent::kAlong);
}

double von_karman_sampled_haar_variance(std::size_t scale, double interval_over_time_scale,
                                        WindComponent component) noexcept {
  if (scale < kSampledScales) return sampled_haar_tables(component)[scale].at(interval_over_time_scale);
  return von_karman_haar_variance(std::ldexp(interval_over_time_scale, static_cast<int>(scale)), component);
}

double von_karman_unfolded_part(double frequency_hz, double interval_s, double time_scale_s) noexcept {
  const double rate = time_scale_s / interval_s;  // everything in units of 1 / time scale
  const double own_x = std::abs(frequency_hz) * time_scale_s;
  const double own = von_karman_density(own_x);
  // Waves that alias to the same frequency are whole rates apart: the first of them are added one by one, the others by
  // their integral.
  constexpr int kTerms = 6;
  const double nearest_x = std::abs(own_x - rate * std::round(own_x / rate));
  double all = von_karman_density(nearest_x);
  for (int k = 1; k <= kTerms; ++k) {
    all += von_karman_density(k * rate - nearest_x) + von_karman_density(k * rate + nearest_x);
  }
  all += 2.0 * von_karman_share((kTerms + 0.5) * rate, std::numeric_limits<double>::infinity(), 1.0) / rate;
  return std::clamp(own / all, 0.0, 1.0);
}

}  // namespace yuragi::wind::turbulence
