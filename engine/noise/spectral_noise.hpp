#pragma once

#include "engine/base/result.hpp"
#include "engine/noise/noise_spec.hpp"
#include "engine/noise/noise_tile.hpp"

namespace yuragi::noise {

/// A 1/f^beta noise (fractional Brownian motion) by spectral synthesis: a Hermitian spectrum of random modes, and one
/// inverse transform. The tile is periodic in every dimension, has mean 0 and variance 1, and stands on a grid of
/// 2^-20.
///
/// Modes: F(k) = |k|^(-b/2) (n1 + j n2), n1 and n2 independent standard normals. The paper's W Nrand / k^(beta/2) at a
/// uniform phase has the same mean power and twice the scatter of a periodogram. A mode that is its own mirror image
/// (every component 0 or size / 2) must be real: sqrt(2) n1, the same mean power. F(0) = 0. |k| counts in cycles an
/// edge. With an integral scale L, (1 / (2 pi 1.339 L)^2 + |k|^2)^(1/2) replaces |k|: von Karman's shape, with the same
/// slope at small scales. L is then the integral scale of a line cut (for beta 5/3, kTransect).
///
/// Deterministic: a mode's numbers come from the seed and its wave vector alone, so the same spec gives the same bits,
/// and a larger tile of the same seed repeats the large waves of a smaller one (scaled to variance 1). Cost: set-up
/// work, about 0.1 us a sample; allocates. Thread-safe: yes. Realtime-safe: no. Fails with a Error, and throws
/// std::bad_alloc. Source: Chiba, "Development of core technology for a noise-based real-time animation engine for
/// fluctuation phenomena", section 2-1; von Karman 1948, "Progress in the statistical theory of turbulence".
Result<Tile1, Error> make_noise_1d(const Spec& spec);
Result<Tile2, Error> make_noise_2d(const Spec& spec);
Result<Tile3, Error> make_noise_3d(const Spec& spec);

}  // namespace yuragi::noise
