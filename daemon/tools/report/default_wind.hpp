#pragma once

#include <optional>

#include "daemon/tools/report/report_numbers.hpp"

namespace yuragi::daemon::tools::report {

/// The values of [wind] that make the daemon's own wind like the one that a sensor measured.
struct DefaultWind {
  double speed_m_s = 0.0;
  std::optional<double> direction_deg;
  double turbulence_intensity = 0.0;
  double length_m = 0.0;
  bool is_length_measured = false;  ///< otherwise the recording does not determine it, and it is the assumed one
};

/// Returns nullopt without a fitted spectrum, or in a calm.
///
/// Intensity and length belong together: the wind that the model makes of both has, in blocks of 10 minutes, the
/// intensity that was measured in such blocks. Of von Karman's variance a block has what is not in its mean
/// (von_karman_mean_variance()), so that the intensity is larger than the measured one. It is not that of the fitted
/// spectrum, which is taken of detrended segments and compares octaves by their logarithms: there a swing of minutes
/// that holds most of the variance counts as little as each quick octave. Only without a block of 10 minutes it is.
/// Thread-safe: yes.
std::optional<DefaultWind> default_wind(const SensorNumbers& sensor);

}  // namespace yuragi::daemon::tools::report
