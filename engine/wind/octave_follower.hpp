#pragma once

#include <array>
#include <cmath>
#include <complex>
#include <cstddef>
#include <numbers>

#include "engine/wind/wind_vector.hpp"

namespace yuragi {

/// A slow signal of vectors taken apart into octave bands, as it comes: a row of one-pole low passes an octave apart,
/// all fed with the last reading; a band is the difference between two neighbours, and the slow mean what the lowest
/// passes. All bands and the mean add up to what the highest passes.
///
/// The steps are exact for a reading that is held. Thread-safe: no. Realtime-safe: yes.
class OctaveFollower {
 public:
  static constexpr std::size_t kBands = 13;
  /// Where the mean ends and band 0 begins, Hz: a memory of 100 s. The last band ends at 13 Hz.
  static constexpr double kLowest_hz = 1.0 / (2.0 * std::numbers::pi * 100.0);

  /// Where band `band` begins, and the band before it ends.
  static double edge_hz(std::size_t band) noexcept { return std::ldexp(kLowest_hz, static_cast<int>(band)); }
  static double centre_hz(std::size_t band) noexcept { return std::numbers::sqrt2 * edge_hz(band); }

  /// Begins with this, as if it had been there for ever.
  void begin(WindVector value) noexcept { passed_.fill(value); }

  /// Goes on by dt_s with `held`.
  void step(WindVector held, double dt_s) noexcept {
    for (std::size_t i = 0; i <= kBands; ++i) {
      const double part = -std::expm1(-2.0 * std::numbers::pi * edge_hz(i) * dt_s);
      passed_[i] = passed_[i] + part * (held - passed_[i]);
    }
  }

  WindVector mean() const noexcept { return passed_[0]; }
  WindVector band(std::size_t band) const noexcept { return passed_[band + 1] - passed_[band]; }

  /// What the mean, weighted, and the bands, weighted, together pass of a wave of this frequency: magnitude and phase.
  static std::complex<double> response(double frequency_hz, double mean_weight,
                                       const std::array<double, kBands>& band_weights) noexcept {
    const auto low_pass = [frequency_hz](std::size_t i) {
      return 1.0 / std::complex<double>(1.0, frequency_hz / edge_hz(i));
    };
    std::complex<double> before = low_pass(0);
    std::complex<double> sum = mean_weight * before;
    for (std::size_t band = 0; band < kBands; ++band) {
      const std::complex<double> after = low_pass(band + 1);
      sum += band_weights[band] * (after - before);
      before = after;
    }
    return sum;
  }

 private:
  std::array<WindVector, kBands + 1> passed_{};  ///< what each low pass lets through
};

}  // namespace yuragi
