#include "engine/wind/turbulence/turbulence_fit.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/wind/turbulence/sampled_turbulence.hpp"
#include "engine/wind/turbulence/von_karman_integrals.hpp"

namespace yuragi::wind::turbulence {
namespace {

/// Scales are used up to this, or up to 32 readings if that is longer.
constexpr double kMaxScale_s = 40.0;
constexpr double kReadingsOfLongestScale = 32.0;
/// Time scales that are tried, in equal steps of the logarithm.
constexpr double kMinTimeScale_s = 0.5;
constexpr double kMaxTimeScale_s = 300.0;
constexpr int kTimeScaleSteps = 48;
/// A scale counts as at most this many observations, so that the finest, which have the most, do not decide alone.
constexpr double kMaxObservations = 50.0;
/// A correction has full weight after a multiple of this number of independent observations.
constexpr double kObservationsToBelieve = 4.0;
/// Haar's response to a frequency f is strongest at 0.37 / tau.
constexpr double kStrongestAt = 0.37;

double square(double x) noexcept {
  return x * x;
}

/// A wind without any turbulence has no logarithm.
constexpr double kMinIntensity = 1e-4;

}  // namespace

Fit::Fit(const Prior& prior, double memory_s, ReadingValue value, WindComponent component)
    : prior_(prior), value_(value), component_(component), squares_(memory_s) {
  make_haar_table();  // now, not on the way
  if (value_ == ReadingValue::kInstant || value_ == ReadingValue::kUnknown) make_sampled_haar_table();
  prior_.intensity = std::max(prior.intensity, kMinIntensity);
  turbulence_ = {prior_.intensity, 8.0};
}

void Fit::fit(double interval_s, double speed_m_s) noexcept {
  if (!(interval_s > 0.0) || !(speed_m_s > 0.0)) return;

  // The variance at each scale, and its weight.
  std::array<double, kScales> log_variance{};
  std::array<double, kScales> weight{};
  std::array<double, kScales> independent{};
  const double longest_s = std::max(kMaxScale_s, kReadingsOfLongestScale * interval_s);
  std::size_t used = 0;
  for (std::size_t scale = 0; scale < kScales; ++scale) {
    const double readings = std::ldexp(1.0, static_cast<int>(scale));
    if (readings * interval_s > longest_s * 1.001) break;
    used = scale + 1;
    independent[scale] = squares_.observations(scale);
    if (independent[scale] < 0.5 || !(squares_.mean(scale) > 0.0)) {
      independent[scale] = 0.0;
      continue;
    }
    log_variance[scale] = std::log(squares_.mean(scale));
    weight[scale] = independent[scale] / (1.0 + independent[scale] / kMaxObservations);
  }

  // The level that suits each time scale best, in closed form; then the best time scale.
  const double log_prior = 2.0 * std::log(prior_.intensity);
  const double prior_time_s = prior_.length_m / speed_m_s;
  double best_cost = std::numeric_limits<double>::infinity();
  for (int step = 0; step <= kTimeScaleSteps; ++step) {
    const double time_scale_s =
        kMinTimeScale_s * std::pow(kMaxTimeScale_s / kMinTimeScale_s, static_cast<double>(step) / kTimeScaleSteps);
    std::array<double, kScales> log_shape{};
    double level = prior_.intensity_weight * log_prior;
    double total = prior_.intensity_weight;
    for (std::size_t scale = 0; scale < used; ++scale) {
      if (weight[scale] == 0.0) continue;
      log_shape[scale] = std::log(shape(scale, interval_s / time_scale_s));
      level += weight[scale] * (log_variance[scale] - log_shape[scale]);
      total += weight[scale];
    }
    level /= total;
    double cost = prior_.intensity_weight * square(level - log_prior) +
                  prior_.length_weight * square(std::log(time_scale_s / prior_time_s));
    for (std::size_t scale = 0; scale < used; ++scale) {
      cost += weight[scale] * square(log_variance[scale] - log_shape[scale] - level);
    }
    if (cost >= best_cost) continue;
    best_cost = cost;
    turbulence_ = {std::exp(0.5 * level), time_scale_s};
    for (std::size_t scale = 0; scale < used; ++scale) {
      const double belief = independent[scale] / (independent[scale] + kObservationsToBelieve);
      log_correction_[scale] = belief * (log_variance[scale] - log_shape[scale] - level);
    }
  }
  interval_s_ = interval_s;
  scales_used_ = used;
}

/// Haar's variance of a scale over the variance of the turbulence.
double Fit::shape(std::size_t scale, double interval_over_time_scale) const noexcept {
  return value_ == ReadingValue::kInstant
             ? von_karman_sampled_haar_variance(scale, interval_over_time_scale, component_)
             : von_karman_haar_variance(std::ldexp(interval_over_time_scale, static_cast<int>(scale)), component_);
}

double Fit::expected(double tau_s) const noexcept {
  return square(turbulence_.intensity) * von_karman_haar_variance(tau_s / turbulence_.time_scale_s, component_) *
         correction(kStrongestAt / tau_s);
}

double Fit::correction(double frequency_hz) const noexcept {
  if (scales_used_ == 0 || !(frequency_hz > 0.0)) return 1.0;
  // Scale s is about the frequency 0.37 / (interval 2^s): between two of them by their logarithms, outside the nearest.
  const double place = std::log2(kStrongestAt / (interval_s_ * frequency_hz));
  const double inside = std::clamp(place, 0.0, static_cast<double>(scales_used_ - 1));
  const auto below = static_cast<std::size_t>(inside);
  const std::size_t next = std::min(below + 1, scales_used_ - 1);
  const double t = inside - static_cast<double>(below);
  return std::exp((1.0 - t) * log_correction_[below] + t * log_correction_[next]);
}

}  // namespace yuragi::wind::turbulence
