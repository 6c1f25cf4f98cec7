#include "engine/noise/turning_noise.hpp"

#include <algorithm>
#include <complex>
#include <cstdint>
#include <utility>
#include <vector>

#include "engine/noise/noise_spectrum.hpp"

namespace yuragi {
namespace {

/// A variance of exactly 1, by what the samples themselves have.
NoiseTile2 tile_of(RealFft& fft) {
  fft.inverse();
  const Standard standard = standard_of(fft.samples());
  NoiseTile2 tile{fft.size(), {}};
  tile.values.reserve(fft.samples().size());
  for (const double sample : fft.samples()) tile.values.push_back(on_grid(sample, standard));
  return tile;
}

}  // namespace

Result<TurningNoise2, NoiseError> make_turning_noise_2d(const NoiseSpec& spec) {
  if (const auto error = check_noise(2, spec)) return *error;
  RealFft fft(2, spec.size);
  fill_spectrum(fft, spec);
  std::vector<std::complex<double>> turned(fft.spectrum().begin(), fft.spectrum().end());
  const std::vector<std::int8_t> signs = turning_signs(fft, spec.seed, spec.from_cycles, spec.to_cycles);
  for (std::size_t i = 0; i < turned.size(); ++i) turned[i] *= std::complex<double>(0.0, -signs[i]);

  TurningNoise2 noise{tile_of(fft), {}};
  std::ranges::copy(turned, fft.spectrum().begin());
  noise.quarter = tile_of(fft);
  return noise;
}

}  // namespace yuragi
