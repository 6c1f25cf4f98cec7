#include "engine/wind/turbulence/von_karman_integrals.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "engine/wind/turbulence/ratio_table.hpp"
#include "engine/wind/turbulence/von_karman.hpp"

namespace yuragi::wind::turbulence {
namespace {

/// The power that Haar's difference passes, at f tau.
double haar_power(double cycles) noexcept {
  const double angle = std::numbers::pi * cycles;
  const double sine = std::sin(angle);
  const double mean = std::abs(angle) < 1e-6 ? 1.0 : sine / angle;
  const double passed = 2.0 * mean * sine;
  return passed * passed;
}

/// Haar's variance for tau / T. Over ln x, by the trapezium rule.
double haar_integral(double ratio, double (*density)(double)) noexcept {
  constexpr int kSteps = 3000;
  const double log_from = std::log(1e-5);
  const double log_step = (std::log(1e4) - log_from) / kSteps;
  double sum = 0.0;
  for (int k = 0; k <= kSteps; ++k) {
    const double x = std::exp(log_from + log_step * k);
    sum += x * density(x) * haar_power(x * ratio) * log_step;
  }
  return sum;
}

const RatioTable& haar_table(WindComponent component) {
  static const RatioTable kAlong([](double ratio) { return haar_integral(ratio, von_karman_density); });
  static const RatioTable kAcross([](double ratio) { return haar_integral(ratio, von_karman_density_across); });
  return component == WindComponent::kAlong ? kAlong : kAcross;
}

}  // namespace

void make_haar_table() {
  haar_table(WindComponent::kAlong);
}

double von_karman_haar_variance(double tau_over_time_scale, WindComponent component) noexcept {
  return haar_table(component).at(tau_over_time_scale);
}

double von_karman_mean_variance(double tau_over_time_scale) noexcept {
  // A Haar variance at tau is four times the difference of the variances of means over tau and over 2 tau. From here on
  // a mean's variance is 2 T / tau: the spectrum's value at 0 over 2 tau.
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

}  // namespace yuragi::wind::turbulence
