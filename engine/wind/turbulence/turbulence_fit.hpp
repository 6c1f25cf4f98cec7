#pragma once

#include <array>
#include <cstddef>

#include "engine/base/state_pass.hpp"
#include "engine/wind/reading_value.hpp"
#include "engine/wind/turbulence/haar_squares.hpp"
#include "engine/wind/turbulence/wind_component.hpp"

namespace yuragi::wind::turbulence {

/// The turbulence of one component of the wind: the parameters of von Karman's spectrum.
struct Turbulence {
  double intensity = 0.2;     ///< standard deviation over the mean speed
  double time_scale_s = 8.0;  ///< integral length scale of u over the mean speed, L / U, also of a component across

  void list_state(StatePass& pass) {
    pass.within(intensity, 0.0, StatePass::kLargest);
    pass.within(time_scale_s, 1e-6, StatePass::kLargest);
  }
};

/// The prior of a fit, which is used if there are few readings.
struct Prior {
  double intensity = 0.2;       ///< standard deviation over the mean speed
  double length_m = 57.0;       ///< integral length scale; 57 m is the IEC's at a height of 10 m (iec_length_scale_m)
  double length_weight = 10.0;  ///< the length counts as this many independent observations
  double intensity_weight = 10.0;  ///< and the intensity
};

/// Fits turbulence to the readings of one component, along the wind or across it, as they arrive: a rolling fit over
/// past readings alone (engine/wind/model.md W28, W29).
///
/// It uses Haar's variances: the mean squares of the differences between neighbouring means over 1, 2, 4 ... readings.
/// Each is the part of von Karman's spectrum after a reading's averaging, or sampling, in closed form except for one
/// tabled integral; intensity and time scale are fitted to all of them by least squares of logarithms. The remaining
/// difference from the spectrum at each scale is kept as a correction, so that the noise above the last scale continues
/// from the measured power there. Speeds are divided by the mean speed of their moment, so that a fit outlives a change
/// of the wind. Source: Allan 1966, Statistics of atomic frequency standards (the variances); von Karman 1948.
///
/// Thread-safe: no. Realtime-safe after construction: yes.
class Fit {
 public:
  static constexpr std::size_t kScales = HaarSquares::kScales;

  Fit(const Prior& prior, double memory_s, ReadingValue value = ReadingValue::kMean,
      WindComponent component = WindComponent::kAlong);

  /// HaarSquares::add() of a difference over the mean speed.
  void add(std::size_t scale, double difference, double weight = 1.0) noexcept {
    squares_.add(scale, difference, weight);
  }

  /// Fades the memory by dt_s.
  void forget(double dt_s) noexcept { squares_.forget(dt_s); }

  /// Sets the value as which the readings are used from the next fit on: kMean or kInstant. Precondition: it was
  /// constructed with that or with kUnknown.
  void take_as(ReadingValue value) noexcept { value_ = value; }

  /// Fits anew, for readings every `interval_s` (above 0), means over that or instantaneous, in a wind of mean
  /// speed `speed_m_s` (above 0).
  void fit(double interval_s, double speed_m_s) noexcept;

  Turbulence turbulence() const noexcept { return turbulence_; }

  /// HaarSquares::observations() and mean() of a scale (below kScales).
  double observations(std::size_t scale) const noexcept { return squares_.observations(scale); }
  double measured(std::size_t scale) const noexcept { return squares_.mean(scale); }
  /// The mean square of differences between neighbouring means over tau_s (above 0), by the fit.
  double expected(double tau_s) const noexcept;

  /// The measured power relative to von Karman's at a frequency: 1 if nothing is known.
  double correction(double frequency_hz) const noexcept;

  void list_state(StatePass& pass) {
    pass(squares_, turbulence_);
    pass.choice(value_, ReadingValue::kUnknown);
    pass.within(std::span<double>(log_correction_), -100.0, 100.0);
    pass.within(interval_s_, 1e-9, StatePass::kLargest);
    pass.index(scales_used_, kScales + 1);
  }

 private:
  double shape(std::size_t scale, double interval_over_time_scale) const noexcept;

  Prior prior_;
  ReadingValue value_;
  WindComponent component_;
  HaarSquares squares_;
  Turbulence turbulence_;
  std::array<double, kScales> log_correction_{};
  double interval_s_ = 1.0;
  std::size_t scales_used_ = 0;
};

}  // namespace yuragi::wind::turbulence
