#pragma once

#include <array>

#include "engine/wind/gust_noise.hpp"

namespace yuragi {

/// Of the squared mean speed, the part that each octave of the noise has for its variance.
using GustShares = std::array<double, GustNoise::kOctaves>;

/// Standard deviation across the wind over that along it, where nobody measured it (IEC 61400-1, normal turbulence).
inline constexpr double kAcrossPerAlong = 0.8;

/// The shares that a turbulence of this intensity and integral length scale gives: together intensity^2 of what the
/// octaves hold. On the tiles von Karman's spectrum over two dimensions (`wind.md` 1 of the specification), along the
/// way the same over one; the way's first octave stands for all that is longer, too. Thread-safe: yes.
GustShares gust_shares(const GustNoise& noise, double intensity, double length_m) noexcept;

}  // namespace yuragi
