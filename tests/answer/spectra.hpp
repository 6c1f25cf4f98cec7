#pragma once

#include <span>
#include <vector>

#include "engine/fft/real_fft.hpp"
#include "tests/answer/series.hpp"

namespace yuragi::answer {

/// Power of a series by frequency: line i stands for i * step_hz, and has the variance of its waves.
struct Spectrum {
  std::vector<double> power;
  double step_hz = 0.0;

  /// The variance from a frequency on, up to another one.
  double variance(double from_hz, double to_hz) const;
  /// The standard deviation of what is at a frequency or above it.
  double deviation_above(double from_hz) const;
  /// Where most power is, in a band.
  double peak_hz(double from_hz, double to_hz) const;
  /// The mean frequency of what is at a frequency or above it, weighted by power; 0 of nothing.
  double centroid_hz(double from_hz) const;

  Spectrum& operator+=(const Spectrum& other);
};

/// Spectra by Welch's method (1967, "The use of fast Fourier transform for the estimation of power spectra"): means
/// over segments of 20 s, each half over the next, without their means, under Hann's window. Thread-safe: no.
class Welch {
 public:
  explicit Welch(double rate_hz, double segment_s = 20.0);

  /// Of nothing (no power) where the series is shorter than a segment.
  Spectrum of(std::span<const float> series);

 private:
  fft::RealFft fft_;
  std::vector<double> window_;
  double window_power_ = 0.0;
  double step_hz_;
};

/// The part of a series at a frequency and above it: its Fourier transform without the lines below. The series counts
/// as periodic. Its end is left out so that the transform is of a round length.
Series high_passed(std::span<const float> series, double rate_hz, double from_hz);

}  // namespace yuragi::answer
