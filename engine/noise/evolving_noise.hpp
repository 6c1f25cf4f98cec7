#pragma once

#include <cstdint>
#include <vector>

#include "engine/base/simd_row.hpp"
#include "engine/fft/real_fft.hpp"
#include "engine/noise/noise_spectrum.hpp"
#include "engine/noise/noise_tile.hpp"
#include "engine/noise/spectral_noise.hpp"

namespace yuragi::noise {

/// A square of noise whose eddies turn over while the wind carries them: no gust that has passed comes back unchanged
/// when the tile wraps.
///
/// Each mode's phase turns at its own rate, F_k(t) = F_k exp(-i s_k w_k t), w_k = turn_rad_s |k|^(2/3) with |k| in
/// cycles an edge, and one inverse transform a frame makes the field of it. The sign s_k is random, and s_-k = -s_k:
/// one sign for all would make the field drift as a whole. No mode's power changes, so that spectrum and variance (1)
/// stay; the few modes that are their own mirror images must be real, and stand still. At first the tile is that of
/// make_noise_2d(spec), bit for bit. Values stand on the grid of 2^-20.
///
/// Owns its tile, spectrum and transform. Thread-safe: no. Realtime-safe: advance() and tile() are; set-up allocates.
/// Phases are fixed-point, so that nothing drifts in a year. Every SIMD row computes the same bits. Cost: about
/// 0.33 ms a frame at 256 x 256. Source: engine/METHOD.md M6; the turnover rate of an eddy of size l goes
/// as l^(-2/3) (Kolmogorov 1941).
class EvolvingNoise {
 public:
  /// `turn_rad_s`, from 0 (frozen) to kMaxTurn_rad_s: how fast the largest waves, as long as the tile, turn their
  /// phase. Fails as make_noise_2d() does; throws std::invalid_argument for a turn out of range, and std::bad_alloc.
  static Result<EvolvingNoise, NoiseError> make(const NoiseSpec& spec, double turn_rad_s,
                                                SimdRow row = best_simd_row());
  static constexpr double kMaxTurn_rad_s = 100.0;

  /// Advances by dt_s (finite; backwards if below 0).
  void advance(double dt_s) noexcept;

  /// The field now. Valid for this object's life; advance() changes it.
  const NoiseTile2& tile() const noexcept { return tile_; }

 private:
  EvolvingNoise(const NoiseSpec& spec, double turn_rad_s, SimdRow row);

  SimdRow row_;
  fft::RealFft fft_;
  Standard standard_;
  NoiseTile2 tile_;

  // A mode of the half spectrum each: as it was at first, how fast it turns, and how far it has turned (2^32 is once
  // around).
  std::vector<double> first_re_, first_im_;
  std::vector<double> turns_per_s_;
  std::vector<std::uint32_t> phase_;
};

}  // namespace yuragi::noise
