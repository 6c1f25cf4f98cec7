#include "engine/noise/spectral_noise.hpp"

#include "engine/noise/noise_spectrum.hpp"

namespace yuragi::noise {
namespace {

/// The values of a checked spec.
std::vector<float> synthesise(int dims, const Spec& spec) {
  fft::RealFft fft(dims, spec.size);
  fill_spectrum(fft, spec);
  fft.inverse();
  return values_on_grid(fft.samples(), standard_of(fft.samples()));
}

}  // namespace

Result<Tile1, Error> make_noise_1d(const Spec& spec) {
  if (const auto error = check_noise(1, spec)) return *error;
  return Tile1{synthesise(1, spec)};
}

Result<Tile2, Error> make_noise_2d(const Spec& spec) {
  if (const auto error = check_noise(2, spec)) return *error;
  return Tile2{spec.size, synthesise(2, spec)};
}

Result<Tile3, Error> make_noise_3d(const Spec& spec) {
  if (const auto error = check_noise(3, spec)) return *error;
  return Tile3{spec.size, synthesise(3, spec)};
}

}  // namespace yuragi::noise
