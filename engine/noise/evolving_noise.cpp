#include "engine/noise/evolving_noise.hpp"

#include <cmath>
#include <complex>
#include <numbers>
#include <stdexcept>

#include "engine/base/kernel.hpp"
#include "engine/math/portable.hpp"
#include "engine/noise/noise_kernels.hpp"

namespace yuragi::noise {
namespace {

constexpr KernelRows<NoiseKernels> kNoiseRows = YURAGI_KERNEL_ROWS(noise_kernels);

}  // namespace

Result<EvolvingNoise, NoiseError> EvolvingNoise::make(const NoiseSpec& spec, double turn_rad_s, SimdRow row) {
  if (!(turn_rad_s >= 0.0 && turn_rad_s <= kMaxTurn_rad_s)) {
    throw std::invalid_argument("an evolving noise turns by 0 to 100 rad/s");
  }
  if (const auto error = check_noise(2, spec)) return *error;
  return EvolvingNoise(spec, turn_rad_s, row);
}

EvolvingNoise::EvolvingNoise(const NoiseSpec& spec, double turn_rad_s, SimdRow row) : row_(row), fft_(2, spec.size) {
  tile_.size = spec.size;
  tile_.values.resize(spec.size * spec.size);
  fill_spectrum(fft_, spec);

  const std::vector<std::int8_t> signs = turning_signs(fft_, spec.seed);
  const std::size_t columns = fft_.row_modes();
  for (std::size_t i = 0; i < fft_.spectrum().size(); ++i) {
    first_re_.push_back(fft_.spectrum()[i].real());
    first_im_.push_back(fft_.spectrum()[i].imag());
    const std::size_t row_index = i / columns;
    const auto wave_z = static_cast<double>(spectrum_row(row_index, spec.size, 2).wave_z);
    const double k = math::length(static_cast<double>(i % columns), wave_z);
    turns_per_s_.push_back(signs[i] * turn_rad_s * math::cube_root(k * k) / (2.0 * std::numbers::pi));
  }
  phase_.assign(fft_.spectrum().size(), 0);

  fft_.inverse();
  standard_ = standard_of(fft_.samples());
  for (std::size_t i = 0; i < tile_.values.size(); ++i) tile_.values[i] = on_grid(fft_.samples()[i], standard_);
}

void EvolvingNoise::advance(double dt_s) noexcept {
  // C++ guarantees that a complex<double> is laid out as two doubles.
  const NoiseKernels& kernels = kNoiseRows[row_];
  kernels.turn_modes({.count = phase_.size(),
                      .first_re = first_re_.data(),
                      .first_im = first_im_.data(),
                      .turns_per_s = turns_per_s_.data(),
                      .dt_s = dt_s,
                      .phase = phase_.data(),
                      .out_modes = reinterpret_cast<double*>(fft_.spectrum().data())});
  fft_.inverse();
  kernels.standardise({.count = tile_.values.size(),
                       .samples = fft_.samples().data(),
                       .mean = standard_.mean,
                       .scale = standard_.scale,
                       .out = tile_.values.data()});
}

}  // namespace yuragi::noise
