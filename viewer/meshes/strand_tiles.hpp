#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "engine/pose/skeleton.hpp"
#include "viewer/meshes/bounds.hpp"
#include "viewer/meshes/sward.hpp"
#include "viewer/meshes/view.hpp"

namespace yuragi::viewer::meshes {

/// A streamed blade of grass at rest, in the shader's layout.
struct TiledBlade {
  glm::vec3 root_m{0.0F};
  float length_m = 0.0F;
  glm::vec2 foot_rad{0.0F};    ///< lean of its foot, if it is an arc
  glm::vec2 turned_rad{0.0F};  ///< how far it is turned up to its tip; its bend is added
  float width_m = 0.0F;
  float facing_rad = 0.0F;  ///< bearing of its flat side
  float chance = 0.0F;      ///< random, 0 to 1: its tint, and what grows on it
  float rank = 0.0F;        ///< 0 to 1: see Thinning
};

/// Streamed strands in square tiles of some hundred, each tile's in a random order, which is that of their ranks: so
/// invisible tiles are omitted as a whole, and only the first blocks of 16 strands of a tile are moved and drawn. Pure;
/// does not allocate after the first few pictures.
class StrandTiles {
 public:
  /// A tile's first strands.
  struct Drawn {
    std::size_t first_slot = 0;  ///< among the strands of all blocks in blocks()
    std::size_t strands = 0;
  };
  struct Level {
    std::size_t rings = 1;  ///< rings of vertices above the root
    std::vector<Drawn> tiles;
  };

  StrandTiles(const pose::StrandSkeleton& strands, const Thinning& thinning, const GrassDetail& detail);

  /// The strands tile by tile, each tile in whole blocks.
  std::span<const TiledBlade> blades() const { return blades_; }
  std::size_t most_strands_a_tile() const { return most_strands_; }

  void set_thinning(const Thinning& thinning) { thinning_ = thinning; }
  /// Chooses what is drawn.
  void choose(const View& view);
  /// The blocks of blades() that hold it, grouped by tile.
  std::span<const std::uint32_t> blocks() const { return blocks_; }
  std::span<const Level> levels() const { return levels_; }

  /// The bends of those blocks, of a pose of the strands.
  std::span<const glm::vec2> bends(const pose::StrandPose& pose);

 private:
  struct Tile {
    Bounds bounds;
    std::size_t first_block = 0, strands = 0;
    float length_m = 0.0F;  // of the longest
    float mean_length_m = 0.0F;
  };

  Thinning thinning_;
  GrassDetail detail_;
  std::vector<std::uint32_t> source_;  // the strand of each of blades_
  std::vector<TiledBlade> blades_;
  std::vector<Tile> tiles_;
  std::size_t most_strands_ = 0;
  std::vector<std::pair<float, std::size_t>> in_view_;  // distance and index of the tile
  std::vector<std::uint32_t> blocks_;
  std::vector<glm::vec2> bends_;
  std::vector<Level> levels_;
};

}  // namespace yuragi::viewer::meshes
