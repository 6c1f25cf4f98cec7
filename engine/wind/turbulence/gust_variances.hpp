#pragma once

#include <array>

#include "engine/wind/turbulence/gust_noise.hpp"

namespace yuragi::wind::turbulence {

/// A variance for each octave of the noise, over the square of the mean speed.
using GustVariances = std::array<double, GustNoise::kOctaves>;

/// Standard deviation across the wind relative to that along it, if it is not measured (engine/wind/model.md W9).
inline constexpr double kAcrossPerAlong = 0.8;

/// The frequency in the middle of an octave that passes at this speed.
double centre_hz(const GustNoise::Octave& octave, double advection_m_s) noexcept;

/// The variance of von Karman's turbulence of this intensity and integral length scale in each octave of the noise
/// (engine/wind/model.md W14). The
/// octaves of the tiles have what a field on the ground, in two dimensions, has at their wavenumbers; those of the way
/// share the rest, by the spectrum along a line. Pure, and slow: some ten thousand multiplications.
GustVariances gust_variances(const GustNoise& noise, double intensity, double length_m) noexcept;

}  // namespace yuragi::wind::turbulence
