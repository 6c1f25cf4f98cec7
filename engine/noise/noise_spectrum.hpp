#pragma once

#include <complex>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "engine/fft/real_fft.hpp"
#include "engine/math/philox.hpp"
#include "engine/noise/noise_spec.hpp"

// Drawing of a noise's modes and standardisation of its samples, shared by make_noise_1d, 2d and 3d. Internal to this
// folder.

namespace yuragi::noise {

/// The random numbers of a noise with this number of dimensions.
math::RandomStream noise_stream(int dims, std::uint64_t seed) noexcept;

/// Returns the error in a spec for this number of dimensions.
std::optional<Error> check_noise(int dims, const Spec& spec) noexcept;

/// Fills the half spectrum of a transform of 1 to 3 dimensions with the random modes of a checked spec, Hermitian.
void fill_spectrum(fft::RealFft& fft, const Spec& spec);

/// The same for modes of any amplitude: `amplitude(wave_x, wave_z, wave_y)` is the standard deviation of a mode's real
/// part, and of its imaginary part. It is evaluated once for each mode that is drawn.
void fill_modes(fft::RealFft& fft, std::uint64_t seed,
                const std::function<double(std::int64_t, std::int64_t, std::int64_t)>& amplitude);

/// The corner of von Karman's shape for an integral scale (above 0), in cycles an edge: 1 / (2 pi 1.339 L).
double corner_cycles(double integral_scale) noexcept;

/// The wave number of index `index` on an axis of `size` samples: negative above half of it.
std::int64_t signed_wave(std::size_t index, std::size_t size) noexcept;

/// The direction in which each mode of the half spectrum turns as eddies turn over: 1 or -1 at random, s_-k = -s_k, and
/// 0 for the modes that are their own mirror images, which must stay real, and for those outside the band, if one is
/// given.
std::vector<std::int8_t> turning_signs(const fft::RealFft& fft, std::uint64_t seed, double from_cycles = 0.0,
                                       double to_cycles = std::numeric_limits<double>::infinity());

/// Scale and offset that give samples mean 0 and variance 1.
struct Standard {
  double mean = 0.0;
  double scale = 1.0;
};
Standard standard_of(std::span<const double> samples) noexcept;

/// A standardised sample, rounded to the grid of 2^-20. All are below 16, so that a float holds each exactly.
inline float on_grid(double sample, Standard standard) noexcept {
  constexpr double kRound = 0x1.8p32;  // adding it rounds doubles to 2^-20
  return static_cast<float>(((sample - standard.mean) * standard.scale + kRound) - kRound);
}

/// All samples of a tile, standardised.
std::vector<float> values_on_grid(std::span<const double> samples, Standard standard);

/// Iterates over the rows of a half spectrum (all axes but the first), each with the row of its mirror images.
struct SpectrumRow {
  std::size_t index;
  std::size_t mirror;
  std::int64_t wave_z;  ///< second axis, signed
  std::int64_t wave_y;  ///< third axis, signed
};
SpectrumRow spectrum_row(std::size_t index, std::size_t size, int dims) noexcept;

}  // namespace yuragi::noise
