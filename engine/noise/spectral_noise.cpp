#include "engine/noise/spectral_noise.hpp"

#include <bit>
#include <cmath>
#include <complex>
#include <numbers>
#include <optional>
#include <span>

#include "engine/fft/real_fft.hpp"
#include "engine/math/philox.hpp"

namespace yuragi {
namespace {

using Mode = std::complex<double>;

/// A mode's own place in the random stream: its signed wave numbers side by side, 24 bits each.
std::uint64_t address_of(std::int64_t wave_x, std::int64_t wave_z) {
  constexpr std::uint64_t kMask = (std::uint64_t{1} << 24U) - 1;
  return (static_cast<std::uint64_t>(wave_x) & kMask) | ((static_cast<std::uint64_t>(wave_z) & kMask) << 24U);
}

/// Fills the half spectrum of a 1-D or 2-D transform with random modes whose power falls as |k|^-exponent.
void fill_spectrum(RealFft& fft, const RandomStream& random, double exponent) {
  const std::span<Mode> spectrum = fft.spectrum();
  const std::size_t size = fft.size();
  const std::size_t half = size / 2;
  const std::size_t columns = fft.row_modes();
  const std::size_t rows = spectrum.size() / columns;

  for (std::size_t z = 0; z < rows; ++z) {
    const auto wave_z = static_cast<std::int64_t>(z) - static_cast<std::int64_t>(z > half ? size : 0);
    const std::size_t mirror_z = (rows - z) % rows;

    for (std::size_t x = 0; x < columns; ++x) {
      const auto wave_x = static_cast<std::int64_t>(x);
      Mode& mode = spectrum[z * columns + x];

      // The constant mode is the mean: 0.
      const auto k_squared = static_cast<double>(wave_x * wave_x + wave_z * wave_z);
      if (k_squared == 0.0) {
        mode = 0.0;
        continue;
      }

      // In the first and the middle column a mode's mirror image stands in the same column: the second of the two
      // is the conjugate of the first, which this loop has already set.
      const bool mirrored_here = x == 0 || x == half;
      if (mirrored_here && mirror_z < z) {
        mode = std::conj(spectrum[mirror_z * columns + x]);
        continue;
      }

      const auto [re, im] = random.normal_pair(address_of(wave_x, wave_z));
      const double amplitude = std::pow(k_squared, -0.25 * exponent);
      const bool self_mirrored = mirrored_here && mirror_z == z;
      mode = self_mirrored ? Mode(amplitude * std::numbers::sqrt2 * re, 0.0) : Mode(amplitude * re, amplitude * im);
    }
  }
}

/// The samples with mean 0 and variance 1, on the grid of 2^-20. None is as large as 16, so that a float holds each
/// exactly.
std::vector<float> standardise(std::span<const double> samples) {
  const auto count = static_cast<double>(samples.size());
  double sum = 0.0;
  for (const double sample : samples) sum += sample;
  const double mean = sum / count;
  double sum_squares = 0.0;
  for (const double sample : samples) sum_squares += (sample - mean) * (sample - mean);
  const double scale = 1.0 / std::sqrt(sum_squares / count);

  std::vector<float> values;
  values.reserve(samples.size());
  for (const double sample : samples) {
    values.push_back(static_cast<float>(std::nearbyint((sample - mean) * scale * 0x1p20) * 0x1p-20));
  }
  return values;
}

std::optional<NoiseError> check(const NoiseSpec& spec, std::size_t max_size) {
  if (spec.size < kMinNoiseSize || spec.size > max_size || !std::has_single_bit(spec.size)) {
    return NoiseError::kSizeNotAllowed;
  }
  if (!(spec.beta >= 0.0 && spec.beta <= kMaxNoiseBeta)) return NoiseError::kBetaOutOfRange;
  return std::nullopt;
}

/// The values of a checked spec.
std::vector<float> synthesise(int dims, const NoiseSpec& spec, std::uint64_t stream) {
  RealFft fft(dims, spec.size);
  fill_spectrum(fft, RandomStream(spec.seed, stream), mode_exponent(dims, spec.beta, spec.meaning));
  fft.inverse();
  return standardise(fft.samples());
}

}  // namespace

std::string_view name_of(NoiseError error) noexcept {
  switch (error) {
    case NoiseError::kSizeNotAllowed:
      return "size-not-allowed";
    case NoiseError::kBetaOutOfRange:
      return "beta-out-of-range";
  }
  return "?";
}

std::string_view name_of(BetaMeaning meaning) noexcept {
  switch (meaning) {
    case BetaMeaning::kRadial:
      return "radial";
    case BetaMeaning::kTransect:
      return "transect";
  }
  return "?";
}

std::string_view explain(NoiseError error) noexcept {
  switch (error) {
    case NoiseError::kSizeNotAllowed:
      return "the size must be a power of two: 8 to 4194304 in one dimension, 8 to 4096 in two";
    case NoiseError::kBetaOutOfRange:
      return "beta must be a number from 0 to 8";
  }
  return "?";
}

double mode_exponent(int dims, double beta, BetaMeaning meaning) noexcept {
  return meaning == BetaMeaning::kTransect ? beta + (dims - 1) : beta;
}

Result<NoiseTile1, NoiseError> make_noise_1d(const NoiseSpec& spec) {
  if (const auto error = check(spec, kMaxNoiseSize1)) return *error;
  return NoiseTile1{synthesise(1, spec, stream_id("spectral noise 1-D"))};
}

Result<NoiseTile2, NoiseError> make_noise_2d(const NoiseSpec& spec) {
  if (const auto error = check(spec, kMaxNoiseSize2)) return *error;
  return NoiseTile2{spec.size, synthesise(2, spec, stream_id("spectral noise 2-D"))};
}

}  // namespace yuragi
