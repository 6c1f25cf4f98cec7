#pragma once

#include <array>
#include <cmath>
#include <complex>
#include <cstddef>
#include <numbers>

#include "engine/base/state_pass.hpp"
#include "engine/wind/wind_vector.hpp"

namespace yuragi::wind::turbulence {

/// Splits a signal of vectors into octave bands as it arrives (engine/wind/model.md W17): a bank of one-pole low
/// passes an octave apart, all fed with the last reading; a band is the difference between two neighbours, and the slow
/// mean the output of the lowest. All bands and the mean add up to the output of the highest.
///
/// The steps are exact for a reading that is held. Thread-safe: no. Realtime-safe: yes.
class OctaveFollower {
 public:
  static constexpr std::size_t kBands = 13;
  /// The frequency at which the mean ends and band 0 begins, Hz: a memory of 100 s. The last band ends at 13 Hz.
  static constexpr double kLowest_hz = 1.0 / (2.0 * std::numbers::pi * 100.0);

  /// The frequency at which band `band` begins, and the band before it ends.
  static double edge_hz(std::size_t band) noexcept { return kLowest_hz * static_cast<double>(1U << band); }
  static double centre_hz(std::size_t band) noexcept { return std::numbers::sqrt2 * edge_hz(band); }

  /// Begins with this value, settled.
  void begin(Vector value) noexcept { passed_.fill(value); }

  /// The part by which each low pass approaches its input within a step: the same for all followers.
  using Parts = std::array<double, kBands + 1>;
  static Parts parts(double dt_s) noexcept {
    Parts parts{};
    for (std::size_t i = 0; i <= kBands; ++i) parts[i] = -std::expm1(-2.0 * std::numbers::pi * edge_hz(i) * dt_s);
    return parts;
  }

  /// Advances by that step, with `held` as input.
  void step(Vector held, const Parts& parts) noexcept {
    for (std::size_t i = 0; i <= kBands; ++i) passed_[i] = passed_[i] + parts[i] * (held - passed_[i]);
  }

  Vector mean() const noexcept { return passed_[0]; }
  Vector band(std::size_t band) const noexcept { return passed_[band + 1] - passed_[band]; }

  /// kLowest_hz over each edge.
  static constexpr std::array<double, kBands + 1> kMinPerEdge = [] {
    std::array<double, kBands + 1> ratios{};
    for (std::size_t i = 0; i <= kBands; ++i) ratios[i] = 1.0 / static_cast<double>(1U << i);
    return ratios;
  }();

  /// The response of the mean (0) and each band (1 + band) to a wave of one frequency: magnitude and phase.
  struct Response {
    std::array<double, kBands + 1> real, imaginary;
    explicit Response(double frequency_hz) noexcept {
      const double lowest_ratio = frequency_hz / kLowest_hz;
      std::array<double, kBands + 1> low_pass_real;
      std::array<double, kBands + 1> low_pass_imaginary;
      for (std::size_t i = 0; i <= kBands; ++i) {
        const double ratio = lowest_ratio * kMinPerEdge[i];
        low_pass_real[i] = 1.0 / (1.0 + ratio * ratio);
        low_pass_imaginary[i] = -ratio * low_pass_real[i];
      }
      real[0] = low_pass_real[0];
      imaginary[0] = low_pass_imaginary[0];
      for (std::size_t i = 1; i <= kBands; ++i) {
        real[i] = low_pass_real[i] - low_pass_real[i - 1];
        imaginary[i] = low_pass_imaginary[i] - low_pass_imaginary[i - 1];
      }
    }
    /// The sum, each with its weight.
    std::complex<double> weighted(const std::array<double, kBands + 1>& weights) const noexcept {
      double sum_real = 0.0;
      double sum_imaginary = 0.0;
      for (std::size_t i = 0; i <= kBands; ++i) {
        sum_real += weights[i] * real[i];
        sum_imaginary += weights[i] * imaginary[i];
      }
      return {sum_real, sum_imaginary};
    }
  };

  void list_state(StatePass& pass) { pass(passed_); }

 private:
  std::array<Vector, kBands + 1> passed_{};  ///< output of each low pass
};

}  // namespace yuragi::wind::turbulence
