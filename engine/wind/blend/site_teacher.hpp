#pragma once

#include <cstddef>

#include "engine/wind/turbulence/site_spectrum.hpp"
#include "engine/wind/turbulence/wind_turbulence.hpp"

namespace yuragi {

/// Teaches a SiteSpectrum what a quick source shows: beside it, its means over 14 s are fitted as if they were a slow
/// sensor at the same mast, and the power that Haar's differences of its readings have at each octave is compared with
/// what that fit says there. Both components count together, where there is a vane.
/// Allocates at construction only. Thread-safe: no. Realtime-safe: yes; a fit every 14 s.
class SiteTeacher {
 public:
  /// `prior` and `fit_memory_s`: of the slow source that is to be corrected.
  SiteTeacher(const TurbulencePrior& prior, double fit_memory_s);

  struct Observation {
    WindVector wind;         ///< a reading: the mean over `interval_s`, which began `interval_s` ago
    WindVector ahead;        ///< unit vector downwind
    double speed_m_s = 0.0;  ///< slow mean
    double interval_s = 0.0;
    bool tells_across = false;
  };
  /// Takes what the source said, and what its own readings show (`quick`, which has taken the reading). What is slower
  /// than SiteSpectrum::kQuick_s teaches nothing, nor does a wind of less than 1 m/s.
  void observe(const Observation& observation, const WindTurbulence& quick, SiteSpectrum& site) noexcept;
  /// After a gap.
  void break_off() noexcept;

 private:
  void teach(const Observation& observation, const WindTurbulence& quick, SiteSpectrum& site) const noexcept;

  WindTurbulence slow_;
  WindVector sum_{};
  std::size_t count_ = 0;
};

}  // namespace yuragi
