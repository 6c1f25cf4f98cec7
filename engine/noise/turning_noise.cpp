#include "engine/noise/turning_noise.hpp"

#include <algorithm>
#include <complex>
#include <cstdint>
#include <utility>
#include <vector>

#include "engine/noise/noise_spectrum.hpp"

namespace yuragi::noise {
namespace {

/// A variance of exactly 1, by what the samples themselves have.
NoiseTile2 tile_of(fft::RealFft& fft) {
  fft.inverse();
  return {fft.size(), values_on_grid(fft.samples(), standard_of(fft.samples()))};
}

}  // namespace

Result<TurningNoise2, NoiseError> make_turning_noise_2d(const NoiseSpec& spec) {
  return TurningNoiseMaker().make(spec);
}

Result<TurningNoise2, NoiseError> TurningNoiseMaker::make(const NoiseSpec& spec) {
  if (const auto error = check_noise(2, spec)) return *error;
  fft::RealFft& fft = transforms_.try_emplace(spec.size, 2, spec.size).first->second;
  fill_spectrum(fft, spec);
  const std::vector<std::int8_t> signs = turning_signs(fft, spec.seed, spec.from_cycles, spec.to_cycles);
  turned_.clear();
  for (std::size_t i = 0; i < signs.size(); ++i) {
    if (signs[i] != 0) turned_.emplace_back(i, fft.spectrum()[i] * std::complex<double>(0.0, -signs[i]));
  }

  TurningNoise2 noise{tile_of(fft), {}};
  std::ranges::fill(fft.spectrum(), std::complex<double>());
  for (const auto& [i, mode] : turned_) fft.spectrum()[i] = mode;
  noise.quarter = tile_of(fft);
  return noise;
}

}  // namespace yuragi::noise
