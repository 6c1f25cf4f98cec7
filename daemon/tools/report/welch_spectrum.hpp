#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "daemon/tools/report/report_numbers.hpp"
#include "engine/fft/real_fft.hpp"
#include "engine/wind/wind_vector.hpp"

namespace yuragi::daemon::tools::report {

/// A sample of an evenly spaced series.
struct EvenSample {
  double speed_m_s = 0.0;
  std::optional<wind::Vector> wind;  ///< nullopt: its direction is not known
};

/// Estimates a spectrum (SpectrumNumbers describes how) from a series of any length, segment by segment, in bounded
/// memory. Thread-safe: no.
class WelchSpectrum {
 public:
  /// `segment`: samples of a segment, a power of two. `is_of_speed`: of the speed, even if samples have a direction.
  WelchSpectrum(std::size_t segment, double step_s, bool is_of_speed);

  /// The next sample of the series.
  void add(const EvenSample& sample);

  /// The series is interrupted: the next sample begins a new run.
  void interrupt() { samples_.clear(); }

  /// The spectrum with its fits; nullopt without a whole segment.
  std::optional<SpectrumNumbers> numbers() const;

 private:
  void take_segment();

  fft::RealFft fft_;
  std::vector<double> window_;
  double window_power_ = 0.0;
  double step_s_;
  bool is_of_speed_;
  std::vector<EvenSample> samples_;
  std::vector<double> power_sum_;
  double squared_speed_sum_m2_s2_ = 0.0;
  std::size_t segments_ = 0;
};

/// Estimates the autocorrelation of blocks of a series. Thread-safe: no.
class IntegralTime {
 public:
  IntegralTime(std::size_t block, double step_s);

  void add(double speed_m_s);
  void interrupt() { samples_.clear(); }

  /// The autocorrelation about the blocks' means, summed by the trapezium rule up to its first zero; nullopt without a
  /// whole block, or if the wind did not vary.
  std::optional<double> seconds() const;

 private:
  std::size_t block_;
  double step_s_;
  fft::RealFft fft_;
  std::vector<double> samples_;
  std::vector<double> sum_;
};

/// The two fits and the octaves of a spectrum. `mean_square_speed_m2_s2`: U^2.
void fit_spectrum(SpectrumNumbers& spectrum, double mean_square_speed_m2_s2);

}  // namespace yuragi::daemon::tools::report
