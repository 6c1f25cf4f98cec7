#pragma once

#include <array>
#include <complex>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "engine/fft/real_fft.hpp"

namespace yuragi::noise {

/// The share of the variance of a wave in the full spectrum, from its wave numbers in cycles an edge (all of them can
/// be negative). Must be 0 or more and even, the same at k and -k.
using WavePower = std::function<double(double cycles_x, double cycles_z, double cycles_y)>;

/// One of the fields of a MovingNoise.
struct MovingField {
  WavePower power;
  std::uint64_t seed = 0;
  /// Correlation of each of its modes with the mode of the same wave in a field of `like_seed`, -1 to 1. Its power does
  /// not depend on it.
  double likeness = 0.0;
  std::uint64_t like_seed = 0;
};

/// For two fields of a MovingNoise, on average over seeds: the variance of each, and their covariance for a likeness of
/// 1. This is the root of the product of the variances only if both have it in the same waves.
struct SharedVariance {
  double one = 0.0, other = 0.0;
  double common = 0.0;
};
/// Evaluates each power about size^dims / 2 times. `dims` and `size` as in MovingNoise.
SharedVariance shared_variance(int dims, std::size_t size, const WavePower& one, const WavePower& other);

/// Several periodic noises of any spectrum on one square or cube, moved together to any place, with their eddies turned
/// by any angle: each mode is
///
///     F_k exp(-i (k . X + s_k turn |k|^(2/3))),
///
/// X the displacement, s_k a random sign with s_-k = -s_k (no drift), |k| in cycles an edge. One
/// inverse transform a field and moment: moving needs no interpolation, and time can go either way.
///
/// A field is Gaussian, of mean 0; its variance is, on average over seeds, the sum of its powers. Waves with two
/// samples on an axis are omitted, because they cannot be moved by a part of a sample, and so is the constant one. Same
/// settings, same bits. Owns its modes and samples: 8 bytes a sample and field, and 20 more a sample. Thread-safe:
/// reading, yes. Realtime-safe: no; 256 x 256 takes a few milliseconds a field, 128 x 128 x 128 a tenth of a second.
/// Source: Taylor 1938 (k . X), engine/METHOD.md M6 (turning).
class MovingNoise {
 public:
  /// `dims` 2 or 3, `size` a power of two that make_noise_2d or make_noise_3d allows. Throws std::invalid_argument,
  /// std::bad_alloc. All fields start at X = 0, turn = 0.
  MovingNoise(int dims, std::size_t size, std::span<const MovingField> fields);

  /// Moves all fields to a displacement, in periods along x, z and y, and turns their eddies by `turn_rad`, which is
  /// the turn of waves as long as an edge.
  void move_to(std::array<double, 3> carried, double turn_rad) noexcept;

  /// The samples of a field, as a Tile2 or Tile3 lays them out. move_to() changes them.
  std::span<const float> samples(std::size_t field) const noexcept { return fields_[field].samples; }

  /// The noise at a place in periods along x, z and y (finite), linear between samples. In two dimensions y is ignored.
  double read(std::size_t field, std::array<double, 3> place) const noexcept;

  int dims() const noexcept { return fft_.dims(); }
  std::size_t size() const noexcept { return fft_.size(); }
  /// Of a field, on average over seeds.
  double variance(std::size_t field) const noexcept { return fields_[field].variance; }

 private:
  struct Field {
    std::vector<std::complex<float>> modes;  ///< of the half spectrum, at X = 0 and turn = 0
    std::vector<float> samples;
    double variance = 0.0;
  };
  Field make_field(const MovingField& field);

  fft::RealFft fft_;
  std::vector<double> turns_;  ///< s_k |k|^(2/3) of each mode
  std::vector<Field> fields_;
};

}  // namespace yuragi::noise
