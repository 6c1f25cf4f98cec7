#include "engine/wind/turbulence/turbulence_fit.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "engine/wind/turbulence/sampled_turbulence.hpp"
#include "engine/wind/turbulence/von_karman.hpp"

namespace yuragi::wind::turbulence {
namespace {

/// Scales are used up to this, or up to 32 readings if that is longer.
constexpr double kLongestScale_s = 40.0;
constexpr double kReadingsOfLongestScale = 32.0;
/// Time scales that are tried, in equal steps of the logarithm.
constexpr double kShortestTimeScale_s = 0.5;
constexpr double kLongestTimeScale_s = 300.0;
constexpr int kTimeScaleSteps = 48;
/// A scale counts as at most so many observations, so that the finest, which have the most, do not alone decide.
constexpr double kMostObservations = 50.0;
/// A correction has full weight after far more independent observations than these.
constexpr double kObservationsToBelieve = 4.0;
/// Haar's response to a frequency f is strongest at 0.37 / tau.
constexpr double kStrongestAt = 0.37;

double square(double x) noexcept {
  return x * x;
}

/// The power that Haar's difference passes, at f tau.
double haar_power(double cycles) noexcept {
  const double angle = std::numbers::pi * cycles;
  const double sine = std::sin(angle);
  const double mean = std::abs(angle) < 1e-6 ? 1.0 : sine / angle;
  return square(2.0 * mean * sine);
}

/// ln of Haar's variance, at equal steps of ln(tau / T) from 1e-3 to 1e3.
class HaarTable {
 public:
  HaarTable() {
    for (std::size_t i = 0; i < kPoints; ++i) log_variance_[i] = std::log(integral(std::exp(log_ratio_of(i))));
  }

  double at(double ratio) const noexcept {
    const double place = (std::log(ratio) - log_ratio_of(0)) / step();
    const double inside = std::clamp(place, 0.0, static_cast<double>(kPoints - 1));
    const auto below = std::min(static_cast<std::size_t>(inside), kPoints - 2);
    const double t = inside - static_cast<double>(below);
    return std::exp((1.0 - t) * log_variance_[below] + t * log_variance_[below + 1]);
  }

 private:
  static constexpr std::size_t kPoints = 121;
  static double step() noexcept { return std::log(1e6) / static_cast<double>(kPoints - 1); }
  static double log_ratio_of(std::size_t i) noexcept { return std::log(1e-3) + step() * static_cast<double>(i); }

  /// Over ln x, by the trapezium rule.
  static double integral(double ratio) noexcept {
    constexpr int kSteps = 3000;
    const double log_from = std::log(1e-5);
    const double log_step = (std::log(1e4) - log_from) / kSteps;
    double sum = 0.0;
    for (int k = 0; k <= kSteps; ++k) {
      const double x = std::exp(log_from + log_step * k);
      sum += x * von_karman_density(x) * haar_power(x * ratio) * log_step;
    }
    return sum;
  }

  std::array<double, kPoints> log_variance_{};
};

const HaarTable& haar_table() {
  static const HaarTable kTable;
  return kTable;
}

}  // namespace

double von_karman_haar_variance(double tau_over_time_scale) noexcept {
  return haar_table().at(tau_over_time_scale);
}

double von_karman_mean_variance(double tau_over_time_scale) noexcept {
  // A Haar variance at tau is four times what a mean over 2 tau has less than one over tau. From here on a mean's
  // variance is 2 T / tau: the spectrum's value at 0 over 2 tau.
  constexpr double kFar = 250.0;
  if (!(tau_over_time_scale > 0.0)) return 1.0;
  const int octaves = std::max(0, static_cast<int>(std::ceil(std::log2(kFar / tau_over_time_scale))));
  double sum = 2.0 / std::ldexp(tau_over_time_scale, octaves);
  for (int octave = 0; octave < octaves; ++octave) {
    const double ratio = std::ldexp(tau_over_time_scale, octave);
    sum += 0.25 * von_karman_haar_variance(std::max(ratio, 1e-3));
  }
  return std::min(sum, 1.0);
}

double von_karman_share(double from_hz, double to_hz, double time_scale_s) noexcept {
  // Of the inertial range the integral is known: it falls as x^(-2/3).
  const auto above = [](double x) { return von_karman_inertial_factor() * 1.5 * std::pow(x, -2.0 / 3.0); };
  constexpr double kFar = 30.0;
  const double from = from_hz * time_scale_s;
  const double to = to_hz * time_scale_s;
  if (from >= kFar) return above(from) - (std::isinf(to) ? 0.0 : above(to));
  double sum = std::isinf(to) ? above(kFar) : 0.0;
  const double end = std::min(to, kFar);
  // Simpson's rule over ln x; below 1e-5 the density is 4.
  const double begin = std::max(from, std::min(1e-5, end));
  sum += 4.0 * (begin - from);
  constexpr int kSteps = 32;
  const double log_step = (std::log(end) - std::log(begin)) / kSteps;
  for (int k = 0; k <= kSteps && log_step > 0.0; ++k) {
    const double x = begin * std::exp(log_step * k);
    const double weight = k == 0 || k == kSteps ? 1.0 : k % 2 == 1 ? 4.0 : 2.0;
    sum += weight / 3.0 * log_step * x * von_karman_density(x);
  }
  if (!std::isinf(to) && to > kFar) sum += above(kFar) - above(to);
  return sum;
}

/// A wind without any turbulence has no logarithm.
constexpr double kLeastIntensity = 1e-4;

TurbulenceFit::TurbulenceFit(const TurbulencePrior& prior, double memory_s, ReadingValue value)
    : prior_(prior), memory_s_(memory_s), value_(value) {
  haar_table();  // made now, not on the way
  if (value_ == ReadingValue::kInstant) make_sampled_haar_table();
  prior_.intensity = std::max(prior.intensity, kLeastIntensity);
  turbulence_ = {prior_.intensity, 8.0};
}

void TurbulenceFit::add(std::size_t scale, double difference, double weight) noexcept {
  if (scale >= kScales || !std::isfinite(difference) || !std::isfinite(weight)) return;
  squares_[scale] += weight * square(difference);
  weights_[scale] += weight;
  counts_[scale] += 1.0;
}

void TurbulenceFit::forget(double dt_s) noexcept {
  const double kept = std::exp(-std::max(dt_s, 0.0) / memory_s_);
  for (double& sum : squares_) sum *= kept;
  for (double& weight : weights_) weight *= kept;
  for (double& count : counts_) count *= kept;
}

void TurbulenceFit::fit(double interval_s, double speed_m_s) noexcept {
  if (!(interval_s > 0.0) || !(speed_m_s > 0.0)) return;

  // The variance at each scale, and its weight: neighbouring differences overlap, so 2^scale of them count about as
  // one.
  std::array<double, kScales> log_variance{};
  std::array<double, kScales> weight{};
  std::array<double, kScales> independent{};
  const double longest_s = std::max(kLongestScale_s, kReadingsOfLongestScale * interval_s);
  std::size_t used = 0;
  for (std::size_t scale = 0; scale < kScales; ++scale) {
    const double readings = std::ldexp(1.0, static_cast<int>(scale));
    if (readings * interval_s > longest_s * 1.001) break;
    used = scale + 1;
    independent[scale] = counts_[scale] / readings;
    if (independent[scale] < 0.5 || !(squares_[scale] > 0.0)) {
      independent[scale] = 0.0;
      continue;
    }
    log_variance[scale] = std::log(squares_[scale] / weights_[scale]);
    weight[scale] = independent[scale] / (1.0 + independent[scale] / kMostObservations);
  }

  // The level that suits each time scale best, in closed form; then the best time scale.
  const double log_prior = 2.0 * std::log(prior_.intensity);
  const double prior_time_s = prior_.length_m / speed_m_s;
  double best_cost = std::numeric_limits<double>::infinity();
  for (int step = 0; step <= kTimeScaleSteps; ++step) {
    const double time_scale_s = kShortestTimeScale_s * std::pow(kLongestTimeScale_s / kShortestTimeScale_s,
                                                                static_cast<double>(step) / kTimeScaleSteps);
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
double TurbulenceFit::shape(std::size_t scale, double interval_over_time_scale) const noexcept {
  return value_ == ReadingValue::kInstant
             ? von_karman_sampled_haar_variance(scale, interval_over_time_scale)
             : von_karman_haar_variance(std::ldexp(interval_over_time_scale, static_cast<int>(scale)));
}

double TurbulenceFit::expected(double tau_s) const noexcept {
  return square(turbulence_.intensity) * von_karman_haar_variance(tau_s / turbulence_.time_scale_s) *
         correction(kStrongestAt / tau_s);
}

double TurbulenceFit::correction(double frequency_hz) const noexcept {
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
