#pragma once

#include <cstddef>
#include <vector>

#include "engine/noise/noise_tile.hpp"
#include "engine/noise/torus.hpp"

namespace yuragi::noise {

/// The levels of a BandLimitedTile2 to read: (1 - weight) of `level` and weight of `next`.
struct BandPick {
  std::size_t level = 0;
  std::size_t next = 0;  ///< the one behind `level`, or the same in the last
  float weight = 0.0F;   ///< 0 to 1, below 1
};

/// One noise at several resolutions, all on the same torus with the same phases: waves that are too fine for the tick
/// rate in a storm are removed, so that nothing jitters from tick to tick.
///
/// Level 0 is the original tile, bit for bit. In level j all waves shorter than end(j) are removed and all longer than
/// twice that are kept, with a smooth step over the octave between; end(0) is the corner of the spectrum, size /
/// sqrt(2) cycles an edge, and each level ends an octave below the one before. Levels are not scaled back to variance
/// 1: the variance of the removed waves is missing. All have the base's size, and stand on the grid of 2^-20.
///
/// Owns its levels (4 bytes a sample each). Set-up work: a transform a level. Thread-safe: reading, yes. Realtime-safe:
/// pick() and level().
class BandLimitedTile2 {
 public:
  /// Throws std::invalid_argument if the tile is not readable, or for 0 levels or more than kMaxLevels; std::bad_alloc.
  explicit BandLimitedTile2(Tile2 base, std::size_t levels = 4);
  static constexpr std::size_t kMaxLevels = 8;

  std::size_t level_count() const noexcept { return levels_.size(); }
  const Tile2& level(std::size_t index) const noexcept { return levels_[index]; }

  /// The maximum cycles an edge of this level's waves.
  double end_cycles(std::size_t index) const noexcept;

  /// Returns the levels to read while the field moves at speed_m_s (at least 0) over a tile of period_m and is shown
  /// rate_hz times a second: waves of |k| speed < pi rate (Nyquist), k in rad/m. Continuous in all three; in weak wind
  /// only level 0, beyond the last level's reach only the last level.
  BandPick pick(double speed_m_s, double rate_hz, double period_m) const noexcept;

 private:
  std::vector<Tile2> levels_;
};

/// The noise at a place: read_noise() of the two levels, mixed. Thread-safe and realtime-safe: yes.
inline float read_noise(const BandLimitedTile2& tile, BandPick pick, TorusPhase at) noexcept {
  const float fine = read_noise(tile.level(pick.level), at);
  return pick.weight > 0.0F ? fine + pick.weight * (read_noise(tile.level(pick.next), at) - fine) : fine;
}

}  // namespace yuragi::noise
