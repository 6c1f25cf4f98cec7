#pragma once

#include "engine/wind/turbulence/wind_component.hpp"

namespace yuragi::wind::turbulence {

// Integrals of von Karman's spectra (von_karman.hpp), of u if no component is given. Thread-safe; realtime-safe after
// make_haar_table().

/// The part of von Karman's variance of u between two frequencies (the upper may be infinite).
double von_karman_share(double from_hz, double to_hz, double time_scale_s) noexcept;

/// Haar's variance over the variance of a von Karman spectrum: the mean square of the difference between two
/// neighbouring means over tau, for tau / time scale; of u, or across the wind. Tabled and interpolated, within 1 %
/// from 1e-3 to 1e3.
double von_karman_haar_variance(double tau_over_time_scale, WindComponent component = WindComponent::kAlong) noexcept;

/// The variance of means over tau, over the variance of a von Karman spectrum, for tau / time scale (above 0): 1 for
/// short ones, 0 for long ones. The rest to 1 is the variance within a block of length tau about its own mean. Within 1
/// % of 1.
double von_karman_mean_variance(double tau_over_time_scale) noexcept;
/// Makes the tables of von_karman_haar_variance() now, in some milliseconds, and not at its first use.
void make_haar_table();

}  // namespace yuragi::wind::turbulence
