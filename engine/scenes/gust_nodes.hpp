#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "engine/base/simd_row.hpp"
#include "engine/wind/turbulence/gust_noise.hpp"

namespace yuragi::scenes {

/// Regular nodes over the ground: line by line from north to south, each line from west to east.
struct GroundNodes {
  double west_m = 0.0, north_m = 0.0;  ///< the first of them, from the middle of all scenes
  double cell_x_m = 0.0, cell_z_m = 0.0;
  std::size_t columns = 0, lines = 0;

  std::size_t size() const noexcept { return columns * lines; }
};

/// A range of nodes of a grid, or of its lines.
struct NodeRange {
  std::size_t first = 0, count = 0;

  template <typename T>
  std::span<T> of(std::span<T> all) const noexcept {
    return all.empty() ? all : all.subspan(first, count);
  }
};

/// Weights of the tiles' octaves: one for each place, or none (1).
struct GustWeights {
  std::array<std::span<const float>, 2 * wind::turbulence::GustNoise::kTileOctaves> along, across;
};

/// The gusts at many nodes of a regular grid at once: GustNoise::local() at each, without its turn into the world.
///
/// Octaves of the middle and the short tiles are read at each node; one whose waves are too short for the nodes is
/// faded out: by log2 of its shortest wave over two cells, between 0 and 1, and is not read if that is 0. Slow changes
/// over the ground, the octaves of the long tiles and the envelope, are read at coarse nodes, 4 an axis and at most 16
/// m apart, and interpolated bilinearly between them: in the middle of a cell of 16 m a wave of 128 m lacks 8 % of its
/// height.
///
/// Allocates when it is made, never afterwards. Thread-safe: no. Realtime-safe: all but construction. Cost: 1.3 ns a
/// node and layer.
class GustNodes {
 public:
  GustNodes(std::shared_ptr<const wind::turbulence::GustNoise> gusts, const GroundNodes& nodes, SimdRow row);

  /// The positions of the nodes, metres east and south of the middle of all scenes.
  std::span<const double> x_m() const noexcept { return fine_.x_m; }
  std::span<const double> z_m() const noexcept { return fine_.z_m; }
  std::span<const double> coarse_x_m() const noexcept { return coarse_.x_m; }
  std::span<const double> coarse_z_m() const noexcept { return coarse_.z_m; }

  /// Returns true if an octave of the tiles is read at the coarse nodes.
  static constexpr bool is_coarse(std::size_t tile_octave) noexcept {
    return tile_octave % wind::turbulence::GustNoise::kTileOctaves < wind::turbulence::GustNoise::kLongOctaves;
  }

  /// All lines of nodes.
  NodeRange all_lines() const noexcept { return {0, lines_.size()}; }
  /// The nodes of some lines: the first, and how many.
  NodeRange nodes_of(const NodeRange& lines) const noexcept {
    return {lines.first * columns_.size(), lines.count * columns_.size()};
  }
  /// The coarse nodes around these lines, in the same form.
  NodeRange coarse_nodes_of(const NodeRange& lines) const noexcept;

  /// Returns true if an octave of the tiles is read.
  bool is_held(std::size_t tile_octave) const noexcept { return held_[tile_octave] > 0.0F; }

  /// Reads the gusts of a moment at the nodes of some lines, with weights for each octave: one for each node of the
  /// grid, or for each coarse node.
  void read(const wind::turbulence::GustNoise::Moment& moment, const GustWeights& weights,
            const NodeRange& lines) noexcept;
  /// The same for the moment when the mean wind has carried the gusts by `carried_m` (east and north). Their eddies do
  /// not turn meanwhile.
  void read_carried(const wind::turbulence::GustNoise::Moment& moment, wind::Vector carried_m,
                    const GustWeights& weights, const NodeRange& lines) noexcept;

  /// The result: m/s at each node, along the mean wind and to the left of it.
  std::span<const float> along_m_s() const noexcept { return fine_.along_m_s; }
  std::span<const float> across_m_s() const noexcept { return fine_.across_m_s; }

 private:
  /// Nodes, their positions on the tiles' tori, and the gusts there.
  struct Nodes {
    Nodes(const wind::turbulence::GustNoise& gusts, const GroundNodes& nodes);
    std::vector<double> x_m, z_m;
    std::array<std::vector<std::uint32_t>, wind::turbulence::GustNoise::kTori> on_torus_x, on_torus_z;
    std::vector<float> along_m_s, across_m_s;
  };
  /// The position of a line or a column of nodes between the coarse ones.
  struct Between {
    std::size_t first = 0;
    float fraction = 0.0F;
  };

  void read_tiles(const wind::turbulence::GustNoise::Moment& moment, const GustWeights& weights,
                  const NodeRange& lines) noexcept;
  void add_coarse(const NodeRange& lines) noexcept;
  static std::vector<Between> between(std::size_t nodes, std::size_t coarse_nodes);

  std::shared_ptr<const wind::turbulence::GustNoise> gusts_;
  SimdRow row_;
  std::array<float, 2 * wind::turbulence::GustNoise::kTileOctaves> held_{};  ///< share of an octave on the nodes
  Nodes fine_, coarse_;
  std::vector<float> envelope_;  ///< at the coarse nodes
  std::vector<Between> columns_, lines_;
  /// The coarse nodes' values on the line at hand.
  std::vector<float> line_along_m_s_, line_across_m_s_, line_envelope_;
};

}  // namespace yuragi::scenes
