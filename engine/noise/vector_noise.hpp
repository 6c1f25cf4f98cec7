#pragma once

#include <complex>
#include <cstddef>
#include <map>
#include <vector>

#include "engine/base/result.hpp"
#include "engine/fft/real_fft.hpp"
#include "engine/noise/noise_spec.hpp"
#include "engine/noise/noise_tile.hpp"

namespace yuragi::noise {

/// A noise vector at each place of a square torus: its components along x and along z, equally large tiles.
struct VectorTile2 {
  Tile2 x, z;
};

/// The horizontal wind on a plane through isotropic, incompressible turbulence: at each mode
///
///     u = s + j sqrt(8/3) (k_z, -k_x) / sqrt(k^2 + kappa^2) psi
///
/// s a vector of two unrelated scalar noises and psi a third one, each with the power (k^2 + kappa^2)^(-4/3). A plane
/// cut through such turbulence has the integral of E(K) (K^2 d_ij - K_i K_j) / (4 pi K^4) over the vertical wavenumber,
/// for von Karman's energy E ~ K^4 / (K^2 + kappa^2)^(17/6): 3/8 (k^2 + kappa^2)^(-4/3) d_ij + (k^2 d_ij - k_i k_j)
/// (k^2 + kappa^2)^(-7/3), the two terms of the sum above (engine/METHOD.md M7). A component is more correlated along
/// its own direction than across it, as in W12 and W13 of engine/wind/model.md, in every direction of the wind.
///
/// Its eddies turn over, all at one rate, without a transform at run time: the field cos(a) first + sin(a) quarter is
/// `first` with the phase of each mode turned by s_k a. The sign s_k is random, and s_-k = -s_k, so that the field does
/// not drift.
struct VectorNoise2 {
  VectorTile2 first;
  VectorTile2 quarter;  ///< of modes -j s_k u_k: turned by a quarter; empty tiles if nothing turns
};

/// Makes vector noises of an octave or so, one after the other; it keeps the transforms, whose memory is half of the
/// cost of a noise. Of each tile, all components have mean 0, variance 1 and no covariance with that across them,
/// in any direction. Set-up work; allocates. Thread-safe: no. Realtime-safe: no.
class VectorNoiseMaker {
 public:
  /// `spec`: beta is 5/3 and its meaning kTransect; kappa is the integral scale's. Waves of two samples along an axis
  /// cannot have a curl, and are omitted. Fails as make_noise_2d(), and with kBetaOutOfRange for another slope.
  Result<VectorNoise2, Error> make(const Spec& spec, bool turns);

 private:
  struct Mode {
    std::size_t index = 0;
    std::complex<double> x, z;
  };
  std::vector<Mode> modes_of(fft::RealFft& fft, const Spec& spec) const;
  VectorTile2 tile_of(fft::RealFft& fft, const std::vector<Mode>& modes);

  std::map<std::size_t, fft::RealFft> transforms_;  ///< by their size
  std::vector<double> x_;                           ///< samples of the first component
};

}  // namespace yuragi::noise
