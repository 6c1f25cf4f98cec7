#pragma once

#include <cstddef>

#include "engine/wind/turbulence/wind_component.hpp"

namespace yuragi::wind::turbulence {

// Instantaneous samples of turbulence with von Karman's spectrum (engine/wind/model.md W39, W40). A sample every
// `interval` has the whole variance: faster waves are aliased to slower ones. Thread-safe.

/// The mean square of the difference between neighbouring means of 2^scale samples, over the variance, by the
/// autocorrelation of the turbulence along the wind or across it. `interval_over_time_scale`: from sample to sample,
/// over L / U (above 0). Tabled and interpolated, within 1 % from 1e-3 to 1e3. Realtime-safe after
/// make_sampled_haar_table().
double von_karman_sampled_haar_variance(std::size_t scale, double interval_over_time_scale,
                                        WindComponent component = WindComponent::kAlong) noexcept;
/// Makes the tables now, in some milliseconds, and not at its first use.
void make_sampled_haar_table();

/// The turbulence's own share of the power of samples at a frequency, S / (S + F): 0 to 1, F being all power that is
/// aliased to it. Realtime-safe.
double von_karman_unfolded_part(double frequency_hz, double interval_s, double time_scale_s) noexcept;

}  // namespace yuragi::wind::turbulence
