#pragma once

#include <complex>
#include <cstddef>
#include <map>
#include <utility>
#include <vector>

#include "engine/fft/real_fft.hpp"
#include "engine/noise/noise_tile.hpp"
#include "engine/noise/spectral_noise.hpp"

namespace yuragi::noise {

/// A noise whose eddies turn over, all at one rate, without a transform at run time: the field
///
///     cos(a) first + sin(a) quarter
///
/// is `first` with the phase of each mode turned by s_k a, F_k exp(-i s_k a). The sign s_k is random, and s_-k = -s_k,
/// so that the field does not drift. Mean and variance stay 0 and 1 whatever a is.
struct TurningNoise2 {
  NoiseTile2 first;    ///< make_noise_2d(spec), bit for bit
  NoiseTile2 quarter;  ///< of modes -i s_k F_k: a quarter turn on
};

/// Makes both. For a band of wavenumbers, an octave or so: an eddy's rate goes as |k|^(2/3), and here there is one for
/// all (EvolvingNoise has one for each mode, and pays a transform a frame). Waves of two samples along an axis cannot
/// turn: spec.to_cycles is at most half the size, else they are missing in `quarter`. Set-up work; allocates.
/// Thread-safe: yes. Realtime-safe: no. Fails as make_noise_2d(). Source: engine/METHOD.md M7.
Result<TurningNoise2, NoiseError> make_turning_noise_2d(const NoiseSpec& spec);

/// The same for many noises one after the other, to the same bits: it keeps the transforms, whose memory is half of the
/// cost of a noise. Set-up work; allocates. Thread-safe: no. Realtime-safe: no.
class TurningNoiseMaker {
 public:
  Result<TurningNoise2, NoiseError> make(const NoiseSpec& spec);

 private:
  std::map<std::size_t, fft::RealFft> transforms_;  ///< by their size
  std::vector<std::pair<std::size_t, std::complex<double>>> turned_;
};

}  // namespace yuragi::noise
