#include "engine/noise/noise_spectrum.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <numbers>

#include "engine/noise/von_karman_corner.hpp"

namespace yuragi::noise {
namespace {

using Mode = std::complex<double>;

/// A mode's index in the random stream: its signed wave numbers packed into 24, 24 and 16 bits.
std::uint64_t address_of(std::int64_t wave_x, std::int64_t wave_z, std::int64_t wave_y) noexcept {
  constexpr std::uint64_t kMask = (std::uint64_t{1} << 24U) - 1;
  return (static_cast<std::uint64_t>(wave_x) & kMask) | ((static_cast<std::uint64_t>(wave_z) & kMask) << 24U) |
         (static_cast<std::uint64_t>(wave_y) << 48U);
}

bool is_in_band(std::int64_t wave_x, std::int64_t wave_z, std::int64_t wave_y, double from_cycles,
                double to_cycles) noexcept {
  const auto k_squared = static_cast<double>(wave_x * wave_x + wave_z * wave_z + wave_y * wave_y);
  return k_squared >= from_cycles * from_cycles && k_squared < to_cycles * to_cycles;
}

}  // namespace

/// The corner for which the integral scale of a line cut is that of the spec (engine/METHOD.md M2).
double corner_cycles(double integral_scale) noexcept {
  return 1.0 / (2.0 * std::numbers::pi * kVonKarmanCorner * integral_scale);
}

std::int64_t signed_wave(std::size_t index, std::size_t size) noexcept {
  return static_cast<std::int64_t>(index) - static_cast<std::int64_t>(index > size / 2 ? size : 0);
}

math::RandomStream noise_stream(int dims, std::uint64_t seed) noexcept {
  constexpr std::array kStreams = {math::stream_id("spectral noise 1-D"), math::stream_id("spectral noise 2-D"),
                                   math::stream_id("spectral noise 3-D")};
  return {seed, kStreams[static_cast<std::size_t>(dims - 1)]};
}

std::optional<Error> check_noise(int dims, const Spec& spec) noexcept {
  constexpr std::array kMaxSizes = {kMaxNoiseSize1, kMaxNoiseSize2, kMaxNoiseSize3};
  const std::size_t max_size = kMaxSizes[static_cast<std::size_t>(dims - 1)];
  if (spec.size < kMinNoiseSize || spec.size > max_size || !std::has_single_bit(spec.size)) {
    return Error::kSizeNotAllowed;
  }
  if (!(spec.beta >= 0.0 && spec.beta <= kMaxNoiseBeta)) return Error::kBetaOutOfRange;
  constexpr std::array kMinTransectBetas = {0.0, kMinTransectBeta2, kMinTransectBeta3};
  if (spec.meaning == BetaMeaning::kTransect && spec.beta < kMinTransectBetas[static_cast<std::size_t>(dims - 1)]) {
    return Error::kTransectTooFlat;
  }
  if (spec.integral_scale != 0.0 && !(spec.integral_scale >= kMinNoiseIntegralScale)) {
    return Error::kIntegralScaleOutOfRange;
  }
  const bool has_waves = spec.from_cycles >= 0.0 && spec.from_cycles <= static_cast<double>(spec.size) / 2.0 &&
                         spec.to_cycles >= 2.0 * spec.from_cycles && spec.to_cycles > 1.0;
  if (!has_waves) return Error::kBandOutOfRange;
  return std::nullopt;
}

SpectrumRow spectrum_row(std::size_t index, std::size_t size, int dims) noexcept {
  const std::size_t rows_z = dims > 1 ? size : 1;
  const std::size_t rows_y = dims > 2 ? size : 1;
  const std::size_t z = index % rows_z;
  const std::size_t y = index / rows_z;
  return {.index = index,
          .mirror = (rows_y - y) % rows_y * rows_z + (rows_z - z) % rows_z,
          .wave_z = signed_wave(z, size),
          .wave_y = signed_wave(y, size)};
}

void fill_modes(fft::RealFft& fft, std::uint64_t seed,
                const std::function<double(std::int64_t, std::int64_t, std::int64_t)>& amplitude) {
  const math::RandomStream random = noise_stream(fft.dims(), seed);
  const std::span<Mode> spectrum = fft.spectrum();
  const std::size_t half = fft.size() / 2;
  const std::size_t columns = fft.row_modes();

  for (std::size_t index = 0; index < spectrum.size() / columns; ++index) {
    const SpectrumRow row = spectrum_row(index, fft.size(), fft.dims());
    for (std::size_t x = 0; x < columns; ++x) {
      const auto wave_x = static_cast<std::int64_t>(x);
      Mode& mode = spectrum[index * columns + x];

      // In the first and the middle column a mode's mirror image is in the same column: the second of the two is the
      // conjugate of the first, which this loop has already set.
      const bool mirrored_here = x == 0 || x == half;
      if (mirrored_here && row.mirror < index) {
        mode = std::conj(spectrum[row.mirror * columns + x]);
        continue;
      }
      const double deviation = amplitude(wave_x, row.wave_z, row.wave_y);
      if (deviation == 0.0) {
        mode = 0.0;
        continue;
      }
      const auto [re, im] = random.normal_pair(address_of(wave_x, row.wave_z, row.wave_y));
      const bool self_mirrored = mirrored_here && row.mirror == index;
      mode = self_mirrored ? Mode(deviation * std::numbers::sqrt2 * re, 0.0) : Mode(deviation * re, deviation * im);
    }
  }
}

void fill_spectrum(fft::RealFft& fft, const Spec& spec) {
  const double exponent = mode_exponent(fft.dims(), spec.beta, spec.meaning);
  const double corner = spec.integral_scale > 0.0 ? corner_cycles(spec.integral_scale) : 0.0;
  fill_modes(fft, spec.seed, [&](std::int64_t wave_x, std::int64_t wave_z, std::int64_t wave_y) {
    // The constant mode is the mean: 0. Waves outside the band are left out.
    const auto k_squared = static_cast<double>(wave_x * wave_x + wave_z * wave_z + wave_y * wave_y);
    const bool is_wanted = is_in_band(wave_x, wave_z, wave_y, spec.from_cycles, spec.to_cycles);
    return k_squared == 0.0 || !is_wanted ? 0.0 : std::pow(corner * corner + k_squared, -0.25 * exponent);
  });
}

std::vector<std::int8_t> turning_signs(const fft::RealFft& fft, std::uint64_t seed, double from_cycles,
                                       double to_cycles) {
  const math::RandomStream random(seed, math::stream_id("evolving noise signs"));
  const std::size_t columns = fft.row_modes();
  const std::size_t half = fft.size() / 2;
  const std::size_t rows = fft.dims() == 1 ? 1 : fft.dims() == 2 ? fft.size() : fft.size() * fft.size();
  std::vector<std::int8_t> signs(rows * columns);
  for (std::size_t index = 0; index < rows; ++index) {
    const SpectrumRow row = spectrum_row(index, fft.size(), fft.dims());
    for (std::size_t x = 0; x < columns; ++x) {
      if (!is_in_band(static_cast<std::int64_t>(x), row.wave_z, row.wave_y, from_cycles, to_cycles)) continue;
      // In the first and the middle column a mode's mirror image, its conjugate, is in the same column.
      const std::size_t i = index * columns + x;
      const bool mirrored_here = x == 0 || x == half;
      if (mirrored_here && row.mirror <= row.index) {
        signs[i] = static_cast<std::int8_t>(row.mirror == row.index ? 0 : -signs[row.mirror * columns + x]);
      } else {
        signs[i] = random.uniform(i) < 0.5 ? std::int8_t{-1} : std::int8_t{1};
      }
    }
  }
  return signs;
}

Standard standard_of(std::span<const double> samples) noexcept {
  const auto count = static_cast<double>(samples.size());
  double sum = 0.0;
  for (const double sample : samples) sum += sample;
  const double mean = sum / count;
  double sum_squares = 0.0;
  for (const double sample : samples) sum_squares += (sample - mean) * (sample - mean);
  return {mean, 1.0 / std::sqrt(sum_squares / count)};
}

std::vector<float> values_on_grid(std::span<const double> samples, Standard standard) {
  std::vector<float> values(samples.size());
  std::ranges::transform(samples, values.begin(), [&](double sample) { return on_grid(sample, standard); });
  return values;
}

}  // namespace yuragi::noise
