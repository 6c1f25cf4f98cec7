#pragma once

#include <cmath>
#include <cstddef>
#include <vector>

#include "engine/fft/real_fft.hpp"
#include "engine/noise/noise_tile.hpp"

namespace yuragi::test {

/// |F(k)|^2 of a periodic line, k = 0 .. size / 2, unnormalised.
inline std::vector<double> line_power(const noise::Tile1& tile) {
  fft::RealFft fft(1, tile.size());
  for (std::size_t i = 0; i < tile.size(); ++i) fft.samples()[i] = static_cast<double>(tile.values[i]);
  fft.forward();
  std::vector<double> power;
  for (const auto mode : fft.spectrum()) power.push_back(std::norm(mode));
  return power;
}

/// |F(kx, kz)|^2 of a square, in the half spectrum's layout (kz outer, size / 2 + 1 columns).
inline std::vector<double> square_power(const noise::Tile2& tile) {
  fft::RealFft fft(2, tile.size);
  for (std::size_t i = 0; i < tile.values.size(); ++i) fft.samples()[i] = static_cast<double>(tile.values[i]);
  fft.forward();
  std::vector<double> power;
  for (const auto mode : fft.spectrum()) power.push_back(std::norm(mode));
  return power;
}

/// The mean of |F|^2 in the integer rings round(|k|) = 0 .. size / 2, each mode of the full spectrum counted once.
inline std::vector<double> ring_power(const noise::Tile2& tile) {
  const std::vector<double> power = square_power(tile);
  const std::size_t half = tile.size / 2;
  std::vector<double> sums(half + 1, 0.0);
  std::vector<double> counts(half + 1, 0.0);
  for (std::size_t z = 0; z < tile.size; ++z) {
    const auto wave_z = static_cast<double>(z > half ? tile.size - z : z);
    for (std::size_t x = 0; x <= half; ++x) {
      const auto ring = static_cast<std::size_t>(std::lround(std::hypot(static_cast<double>(x), wave_z)));
      if (ring > half) continue;
      const double weight = x == 0 || x == half ? 1.0 : 2.0;
      sums[ring] += weight * power[z * (half + 1) + x];
      counts[ring] += weight;
    }
  }
  for (std::size_t ring = 0; ring <= half; ++ring) sums[ring] /= counts[ring];
  return sums;
}

/// The mean periodogram of a square's rows (along x).
inline std::vector<double> row_power(const noise::Tile2& tile) {
  std::vector<double> mean(tile.size / 2 + 1, 0.0);
  fft::RealFft fft(1, tile.size);
  for (std::size_t z = 0; z < tile.size; ++z) {
    for (std::size_t x = 0; x < tile.size; ++x) fft.samples()[x] = static_cast<double>(tile.at(x, z));
    fft.forward();
    for (std::size_t k = 0; k < mean.size(); ++k) mean[k] += std::norm(fft.spectrum()[k]);
  }
  for (double& power : mean) power /= static_cast<double>(tile.size);
  return mean;
}

/// The mean of |F|^2 of a cube in the integer shells round(|k|) = 0 .. size / 2, each mode of the full spectrum once.
inline std::vector<double> shell_power(const noise::Tile3& tile) {
  fft::RealFft fft(3, tile.size);
  for (std::size_t i = 0; i < tile.values.size(); ++i) fft.samples()[i] = static_cast<double>(tile.values[i]);
  fft.forward();
  const std::size_t half = tile.size / 2;
  std::vector<double> sums(half + 1, 0.0);
  std::vector<double> counts(half + 1, 0.0);
  const auto wave = [&](std::size_t index) { return static_cast<double>(index > half ? tile.size - index : index); };
  for (std::size_t i = 0; i < fft.spectrum().size(); ++i) {
    const std::size_t x = i % (half + 1);
    const std::size_t row = i / (half + 1);
    const auto shell = static_cast<std::size_t>(
        std::lround(std::hypot(static_cast<double>(x), wave(row % tile.size), wave(row / tile.size))));
    if (shell > half) continue;
    const double weight = x == 0 || x == half ? 1.0 : 2.0;
    sums[shell] += weight * std::norm(fft.spectrum()[i]);
    counts[shell] += weight;
  }
  for (std::size_t shell = 0; shell <= half; ++shell) sums[shell] /= counts[shell];
  return sums;
}

/// The mean periodogram of a cube's rows (along x).
inline std::vector<double> row_power(const noise::Tile3& tile) {
  std::vector<double> mean(tile.size / 2 + 1, 0.0);
  fft::RealFft fft(1, tile.size);
  for (std::size_t row = 0; row < tile.size * tile.size; ++row) {
    for (std::size_t x = 0; x < tile.size; ++x)
      fft.samples()[x] = static_cast<double>(tile.values[row * tile.size + x]);
    fft.forward();
    for (std::size_t k = 0; k < mean.size(); ++k) mean[k] += std::norm(fft.spectrum()[k]);
  }
  for (double& power : mean) power /= static_cast<double>(tile.size * tile.size);
  return mean;
}

/// The exponent b of a power law power[k] ~ k^-b: least squares in log-log over k = first .. last.
inline double falling_exponent(const std::vector<double>& power, std::size_t first, std::size_t last) {
  const auto count = static_cast<double>(last - first + 1);
  double sum_x = 0.0;
  double sum_y = 0.0;
  double sum_xx = 0.0;
  double sum_xy = 0.0;
  for (std::size_t k = first; k <= last; ++k) {
    const double x = std::log(static_cast<double>(k));
    const double y = std::log(power[k]);
    sum_x += x;
    sum_y += y;
    sum_xx += x * x;
    sum_xy += x * y;
  }
  return -(count * sum_xy - sum_x * sum_y) / (count * sum_xx - sum_x * sum_x);
}

}  // namespace yuragi::test
