#pragma once

#include <optional>

#include "daemon/tools/report/report_numbers.hpp"
#include "engine/wind/blend/site_spectrum_fit.hpp"

namespace yuragi::daemon::tools::report {

/// Fits the SiteSpectrum to the readings of a fast sensor in a recording, as the daemon does live. Thread-safe: no.
class SiteTally {
 public:
  /// `prior`: of the slow source that is to be corrected. `interval_s`: the sensor's.
  SiteTally(const wind::turbulence::Prior& prior, double interval_s);

  /// The next believed reading; `wind`: with the last known direction; empty if there is none yet.
  void add(double time_s, double speed_m_s, const std::optional<wind::Vector>& wind);

  /// Nullopt if the sensor is too slow, or was never live for long enough.
  std::optional<SiteNumbers> numbers() const;

 private:
  double interval_s_;
  double length_m_;
  wind::turbulence::WindTurbulence quick_;
  wind::blend::SiteSpectrumFit site_fit_;
  wind::turbulence::SiteSpectrum site_;
  std::optional<double> last_s_;
  double measured_s_ = 0.0;
  wind::Vector mean_{};
  double speed_m_s_ = 0.0;
};

}  // namespace yuragi::daemon::tools::report
