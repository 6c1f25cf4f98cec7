#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "engine/pose/skeleton.hpp"
#include "viewer/meshes/bounds.hpp"
#include "viewer/meshes/sward.hpp"
#include "viewer/meshes/view.hpp"

namespace yuragi::viewer::meshes {

/// A streamed blade of grass, as the shader reads it.
struct TiledBlade {
  float root_x_m = 0.0F, root_y_m = 0.0F, root_z_m = 0.0F;
  float width_m = 0.0F;
  float facing_rad = 0.0F;  ///< bearing of its flat side
  float chance = 0.0F;      ///< 0 to 1: its tint, and what grows on it
  float rank = 0.0F;        ///< 0 to 1: see Thinning
  float length_m = 0.0F;
};

/// Streamed strands in square tiles of some hundred, each tile's in a random order, which is that of their ranks: so
/// what is not in view is left out tile by tile, and of a tile only its first blocks of 16 strands are moved and drawn.
/// Pure; does not allocate after the first few pictures.
class StrandTiles {
 public:
  /// A tile's first strands.
  struct Drawn {
    std::size_t first_slot = 0;  ///< among the strands of all blocks in blocks()
    std::size_t strands = 0;
  };
  struct Level {
    std::size_t rings = 1;  ///< of vertices above the root
    std::vector<Drawn> tiles;
  };

  StrandTiles(const pose::StrandSkeleton& strands, const Thinning& thinning);

  /// The same strands tile by tile, each tile in whole blocks.
  const pose::StrandSkeleton& skeleton() const { return tiled_; }
  /// One for each of its strands.
  std::span<const TiledBlade> blades() const { return blades_; }
  std::size_t most_strands_a_tile() const { return most_strands_; }

  /// Chooses what is drawn.
  void choose(const View& view);
  /// The blocks of skeleton() that hold it, those of a tile one behind the other.
  std::span<const std::uint32_t> blocks() const { return blocks_; }
  std::span<const Level> levels() const { return levels_; }

  /// Takes the bends of those blocks from a pose of the strands to one of skeleton().
  void take(const pose::StrandPose& pose, pose::StrandPose& tiled) const;

 private:
  struct Tile {
    Bounds bounds;
    std::size_t first_block = 0, strands = 0;
    float length_m = 0.0F;
  };

  Thinning thinning_;
  pose::StrandSkeleton tiled_;
  std::vector<std::uint32_t> source_;  // of each strand of tiled_
  std::vector<TiledBlade> blades_;
  std::vector<Tile> tiles_;
  std::size_t most_strands_ = 0;
  std::vector<std::uint32_t> blocks_;
  std::vector<Level> levels_;
};

}  // namespace yuragi::viewer::meshes
