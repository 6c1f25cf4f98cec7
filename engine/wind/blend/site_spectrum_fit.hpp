#pragma once

#include <cstddef>

#include "engine/base/state_pass.hpp"
#include "engine/wind/turbulence/site_spectrum.hpp"
#include "engine/wind/turbulence/wind_turbulence.hpp"

namespace yuragi::wind::blend {

/// Updates a SiteSpectrum from a fast source: its means over 14 s are fitted like those of a slow sensor on the same
/// mast, and the power of the fast readings at each octave (Haar's differences) is compared with that fit. Both
/// components count together, if there is a vane. Allocates at construction only. Thread-safe: no. Realtime-safe: yes;
/// a fit every 14 s.
class SiteSpectrumFit {
 public:
  /// `prior` and `fit_memory_s`: of the slow source that is to be corrected.
  SiteSpectrumFit(const turbulence::Prior& prior, double fit_memory_s);

  struct Observation {
    Vector wind;             ///< a reading: the mean over `interval_s`, which began `interval_s` ago
    Vector ahead;            ///< unit vector downwind
    double speed_m_s = 0.0;  ///< slow mean
    double interval_s = 0.0;
    bool has_across = false;
  };
  /// Takes a reading of the source, and the turbulence of its own readings (`quick`, which has taken the reading).
  /// Sources slower than SiteSpectrum::kQuick_s and winds below 1 m/s change nothing.
  void observe(const Observation& observation, const turbulence::WindTurbulence& quick,
               turbulence::SiteSpectrum& site) noexcept;
  /// After a gap.
  void break_off() noexcept;

  void list_state(StatePass& pass) { pass(slow_, sum_, count_); }

 private:
  void update(const Observation& observation, const turbulence::WindTurbulence& quick,
              turbulence::SiteSpectrum& site) const noexcept;

  turbulence::WindTurbulence slow_;
  Vector sum_{};
  std::size_t count_ = 0;
};

}  // namespace yuragi::wind::blend
