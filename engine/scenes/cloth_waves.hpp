#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "engine/base/state_pass.hpp"
#include "engine/scenes/cloth_noise.hpp"

namespace yuragi::scenes {

/// The places at which the waves of a cloth are read: rows at even steps in the direction of the waves, with the same
/// columns in each.
struct ClothWaveGrid {
  double first_m = 0.0;  ///< the first row
  double step_m = 0.1;   ///< above 0
  std::size_t rows = 1;
  std::span<const float> across_m;  ///< each column, across the way; at least one
  double slant = 0.0;  ///< delay of the waves with a column's position across their direction: their fronts lean
};

/// Waves that run along a cloth from its fixed edge to its free one: a ClothNoise, minus its value half a wave behind,
/// which keeps only running waves. (Along a line, noise of two dimensions has waves of all directions, of which those
/// nearly parallel to the line look long and slow: they are removed.) Mean 0, variance near 0.8, within
/// ClothNoise::kLargest. Allocates when it is made. Thread-safe: no. Realtime-safe: yes.
class ClothWaves {
 public:
  /// Waves of shortest_m to longest_m, at least an octave apart.
  ClothWaves(double shortest_m, double longest_m, const ClothWaveGrid& grid, std::uint64_t seed, SimdRow row);

  /// Moves them for dt_s, at speed_m_s.
  void shift(double speed_m_s, double dt_s) noexcept { noise_.shift(speed_m_s, 0.0, dt_s); }

  void sample() noexcept;

  /// The samples: row after row, a value per column.
  std::span<const float> values() const noexcept { return std::span(values_).first(count_); }

  /// The maximum change of a value in a tick, at up to speed_m_s.
  double largest_change(double speed_m_s, double dt_s) const noexcept;

  void list_state(StatePass& pass) { pass(noise_); }

 private:
  ClothNoise noise_;
  std::size_t count_;   ///< of values
  std::size_t behind_;  ///< how many values half a wave is
  CarriedPlaces places_;
  std::vector<float> values_;
};

}  // namespace yuragi::scenes
