#pragma once

#include <cmath>
#include <complex>
#include <span>
#include <vector>

#include "engine/fft/real_fft.hpp"
#include "engine/wind/wind_vector.hpp"

namespace yuragi::proof {

/// Spectra of a wind: segments of equal length that overlap by at least a half and together reach from one end to the
/// other, each less its straight line and under a Hann window (Welch 1967, The use of fast Fourier transform for the
/// estimation of power spectra).
class Welch {
 public:
  using Bins = std::vector<std::complex<double>>;
  /// A segment of one component after another: |bin|^2 is the one-sided density, m^2/s^2/Hz. Bin k is k / segment_s.
  using Segments = std::vector<Bins>;

  /// Bins above `top_hz` are not kept.
  Welch(double rate_hz, double segment_s, double top_hz);

  /// Of both components: first those of u, then those of v. At least a segment long.
  Segments segments(std::span<const wind::Vector> samples);

  /// How much each of so many samples counts in the density, 1 on average: those at both ends count little.
  std::vector<double> weights(std::size_t samples) const;

  /// The density of both components together (the trace).
  static std::vector<double> density(const Segments& segments);

  double step_hz() const noexcept { return step_hz_; }

 private:
  std::vector<std::size_t> starts(std::size_t samples) const;
  Bins transform();

  double step_hz_;
  std::size_t kept_;
  double scale_;
  std::vector<double> window_;
  fft::RealFft fft_;
};

/// A band of frequencies, from `from_hz` on and below `to_hz`.
struct Band {
  double from_hz = 0.0;
  double to_hz = 0.0;
};

/// Octaves downward from `top_hz`; the last is what is left of one above `bottom_hz`. In rising order.
std::vector<Band> octaves_down(double top_hz, double bottom_hz);

/// The power in a band of a density that is given at steps of step_hz.
double power_in(const std::vector<double>& density, double step_hz, Band band);

/// What a wind adds up to: means and variance.
struct WindMoments {
  wind::Vector mean;
  double mean_speed_m_s = 0.0;
  double variance_m2_s2 = 0.0;  ///< of u and of v together
};
WindMoments moments_of(std::span<const wind::Vector> samples);

inline double decibel(double ratio) noexcept {
  return 10.0 * std::log10(ratio);
}

}  // namespace yuragi::proof
