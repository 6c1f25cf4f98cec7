#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

namespace yuragi::viewer::app {

/// The wind's speed of the last minute: the one that moves the scenes, and the measured one. Pure: time is a parameter.
/// Allocates nothing once it is full. Thread-safe: no.
class WindTrace {
 public:
  static constexpr double kInterval_s = 0.125;
  static constexpr std::size_t kSamples = 480;  // 60 s

  WindTrace();

  /// Takes a speed at a time of the sender; means over kInterval_s are kept. If time goes back, or more than a minute
  /// is missing, the trace begins again; a shorter gap is filled with the speed before it.
  void hear(double time_s, double speed_m_s, std::optional<double> measured_m_s);

  /// m/s, the oldest first; as many as were received.
  const std::vector<float>& speeds_m_s() const { return speeds_; }
  /// In the same order; 0 if no sensor was believed.
  const std::vector<float>& measured_m_s() const { return measured_; }

 private:
  void put(double speed_m_s, double measured_m_s);

  std::vector<float> speeds_, measured_;
  std::optional<double> ends_s_;  // end of the interval that is being averaged
  double sum_ = 0.0;
  double measured_now_ = 0.0;
  int count_ = 0;
};

/// A band of a power spectrum.
struct SpectrumBand {
  double frequency_hz = 0.0;  ///< its middle
  double density_m2_s = 0.0;  ///< of the variance, one-sided: (m/s)^2 a hertz
};
/// The power spectral density of speeds that are WindTrace::kInterval_s apart, in bands of equal ratios from one over
/// their duration to 4 Hz: a periodogram with Hann's window, of what is left without the mean (Welch 1967, "The use of
/// fast Fourier transform for the estimation of power spectra", of one segment). Empty below 64 speeds.
std::vector<SpectrumBand> spectrum_of(const std::vector<float>& speeds_m_s);

}  // namespace yuragi::viewer::app
