#include "engine/noise/vector_noise.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>

#include "engine/math/philox.hpp"
#include "engine/noise/noise_spectrum.hpp"

namespace yuragi::noise {
namespace {

constexpr double kBeta = 5.0 / 3.0;

/// The symmetric matrix that makes two components of these variances and this covariance unrelated, each of variance 1:
/// the inverse of the root of their covariance matrix.
struct Whitening {
  double x = 1.0, z = 1.0, across = 0.0;

  Whitening(double variance_x, double variance_z, double covariance) noexcept {
    const double root = std::sqrt(variance_x * variance_z - covariance * covariance);
    const double scale = 1.0 / (root * std::sqrt(variance_x + variance_z + 2.0 * root));
    x = scale * (variance_z + root);
    z = scale * (variance_x + root);
    across = -scale * covariance;
  }
};

}  // namespace

Result<VectorNoise2, Error> VectorNoiseMaker::make(const Spec& spec, bool turns) {
  if (const auto error = check_noise(2, spec)) return *error;
  if (spec.beta != kBeta || spec.meaning != BetaMeaning::kTransect) return Error::kBetaOutOfRange;
  fft::RealFft& fft = transforms_.try_emplace(spec.size, 2, spec.size).first->second;
  std::vector<Mode> modes = modes_of(fft, spec);
  VectorNoise2 noise{.first = tile_of(fft, modes), .quarter = {}};
  if (!turns) return noise;
  const std::vector<std::int8_t> signs = turning_signs(fft, spec.seed, spec.from_cycles, spec.to_cycles);
  for (Mode& mode : modes) {
    const std::complex<double> turn(0.0, -signs[mode.index]);
    mode.x *= turn;
    mode.z *= turn;
  }
  noise.quarter = tile_of(fft, modes);
  return noise;
}

std::vector<VectorNoiseMaker::Mode> VectorNoiseMaker::modes_of(fft::RealFft& fft, const Spec& spec) const {
  const auto fill = [&](std::uint64_t stream) {
    Spec scalar = spec;
    scalar.seed ^= stream;
    fill_spectrum(fft, scalar);
  };
  std::vector<Mode> modes;
  fill(math::stream_id("vector noise x"));
  for (std::size_t i = 0; i < fft.spectrum().size(); ++i) {
    const std::size_t half = fft.size() / 2;
    const bool is_of_two_samples = i % fft.row_modes() == half || i / fft.row_modes() == half;
    if (!is_of_two_samples && fft.spectrum()[i] != 0.0) modes.push_back({i, fft.spectrum()[i], 0.0});
  }
  fill(math::stream_id("vector noise z"));
  for (Mode& mode : modes) mode.z = fft.spectrum()[mode.index];
  fill(math::stream_id("vector noise curl"));
  const double corner = spec.integral_scale > 0.0 ? corner_cycles(spec.integral_scale) : 0.0;
  for (Mode& mode : modes) {
    const auto wave_x = static_cast<double>(mode.index % fft.row_modes());
    const auto wave_z = static_cast<double>(signed_wave(mode.index / fft.row_modes(), fft.size()));
    const double length = std::sqrt(wave_x * wave_x + wave_z * wave_z + corner * corner);
    const std::complex<double> psi =
        std::complex<double>(0.0, std::sqrt(8.0 / 3.0) / length) * fft.spectrum()[mode.index];
    mode.x += wave_z * psi;
    mode.z -= wave_x * psi;
  }
  return modes;
}

VectorTile2 VectorNoiseMaker::tile_of(fft::RealFft& fft, const std::vector<Mode>& modes) {
  const auto transform = [&](std::complex<double> Mode::*component) {
    std::ranges::fill(fft.spectrum(), std::complex<double>());
    for (const Mode& mode : modes) fft.spectrum()[mode.index] = mode.*component;
    fft.inverse();
  };
  transform(&Mode::x);
  x_.assign(fft.samples().begin(), fft.samples().end());
  transform(&Mode::z);
  const std::span<const double> z = fft.samples();
  double xx = 0.0;
  double zz = 0.0;
  double xz = 0.0;
  for (std::size_t i = 0; i < z.size(); ++i) {
    xx += x_[i] * x_[i];
    zz += z[i] * z[i];
    xz += x_[i] * z[i];
  }
  const auto count = static_cast<double>(z.size());
  const Whitening whitening(xx / count, zz / count, xz / count);
  VectorTile2 tile{.x = {fft.size(), std::vector<float>(z.size())}, .z = {fft.size(), std::vector<float>(z.size())}};
  for (std::size_t i = 0; i < z.size(); ++i) {
    tile.x.values[i] = on_grid(whitening.x * x_[i] + whitening.across * z[i], {});
    tile.z.values[i] = on_grid(whitening.across * x_[i] + whitening.z * z[i], {});
  }
  return tile;
}

}  // namespace yuragi::noise
