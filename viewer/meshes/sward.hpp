#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "viewer/meshes/view.hpp"

namespace yuragi::viewer::meshes {

/// The thinning of a stand of grass with the distance from the eye: every blade has a rank from 0 to 1, and is drawn
/// while its rank is below share(). The remaining ones are wider. The shaders have the same law (kept_share() in
/// blade.part.glsl).
struct Thinning {
  float blades_per_m2 = 200.0F;     ///< of the whole stand
  float drawn_at_1m_per_m2 = 0.0F;  ///< the most that are drawn at a distance of 1 m; falls with its power -1.5

  float factor() const { return drawn_at_1m_per_m2 / blades_per_m2; }
  float share(float distance_m) const;
};

/// The amount of grass that is drawn. With fewer blades they are omitted nearer to the eye, and the others are drawn
/// wider.
struct GrassDetail {
  float drawn_at_1m_per_m2 = 0.0F;  ///< see Thinning
  float off_px = 0.6F;              ///< maximum distance of an arc from its chords
  float reach_m = 60.0F;            ///< tall blades end there

  /// The number of vertices of a blade of this length at a distance, at least 1: an arc that turns by a radian is an
  /// eighth of its length off one chord, and 1 / n^2 of that off n chords. `pixel_m`: the size of a pixel at one metre.
  std::size_t rings(float length_m, float distance_m, float pixel_m) const;
};
inline constexpr GrassDetail kMuchGrass{.drawn_at_1m_per_m2 = 24'000.0F};
inline constexpr GrassDetail kMediumGrass{.drawn_at_1m_per_m2 = 8'000.0F, .off_px = 1.0F};
inline constexpr GrassDetail kLittleGrass{.drawn_at_1m_per_m2 = 2'000.0F, .off_px = 3.0F, .reach_m = 40.0F};

/// A blade of the sward's tile, in the shader's layout.
struct SwardBlade {
  float x = 0.0F, z = 0.0F;  ///< on the tile, 0 to 1
  float facing_rad = 0.0F;   ///< bearing of its flat side
  float height = 1.0F;       ///< as a part of the mean
  float heading_rad = 0.0F;  ///< where it droops to
  float chance = 0.0F;       ///< random, 0 to 1: its tint, and what grows on it
  float droop = 1.0F;        ///< as a part of the mean
  float sway = 1.0F;         ///< its bend in the wind, as a part of the bend of the ground's nodes
};

/// `count` blades, evenly scattered, in the order of their ranks: blade i has rank (i + 0.5) / count, and any first
/// part of them is scattered evenly, too. Always the same.
std::vector<SwardBlade> sward_blades(std::size_t count);

/// A tile of the sward that is in view.
struct SwardTile {
  glm::vec2 origin_m{0.0F};  ///< its north-western corner
  float turn = 0.0F;         ///< 0 to 7: by how many quarters it is turned, and whether it is mirrored
  float blades = 0.0F;       ///< number of its first blades that are drawn
};

/// Lays tiles around the eye and chooses those in view. Pure; does not allocate after the first few pictures.
class SwardTiles {
 public:
  static constexpr float kTile_m = 2.5F;
  /// Level i has kLevels - i rings of vertices.
  static constexpr std::size_t kLevels = 6;

  /// Tiles of the whole stand have `blades` each; none is laid farther from the eye than the detail's reach. Most
  /// blades have the length `length_m`, and none is higher than `height_m`.
  SwardTiles(std::size_t blades, const Thinning& thinning, const GrassDetail& detail, float length_m, float height_m)
      : blades_(blades), thinning_(thinning), detail_(detail), length_m_(length_m), height_m_(height_m) {}

  void set_thinning(const Thinning& thinning) { thinning_ = thinning; }

  /// `is_free`: returns true if a blade can stand in a rectangle of the ground (x, z, metres).
  template <class IsFree>
  void choose(const View& view, IsFree&& is_free) {
    candidates_.clear();
    find_in_view(view);
    for (std::vector<SwardTile>& level : levels_) level.clear();
    for (const Candidate& tile : candidates_) {
      if (is_free(tile.tile.origin_m, tile.tile.origin_m + kTile_m)) levels_[tile.level].push_back(tile.tile);
    }
  }

  /// Those of a level of detail, near ones first.
  std::span<const SwardTile> level(std::size_t level) const { return levels_[level]; }

 private:
  struct Candidate {
    SwardTile tile;
    std::size_t level = 0;
    float distance_m = 0.0F;
  };
  void find_in_view(const View& view);

  std::size_t blades_;
  Thinning thinning_;
  GrassDetail detail_;
  float length_m_, height_m_;
  std::vector<Candidate> candidates_;
  std::array<std::vector<SwardTile>, kLevels> levels_;
};

/// The triangles of `count` ribbons with `rings` rings, of 2 rings + 1 vertices each, one ribbon after the other.
std::vector<std::uint32_t> ribbon_triangles(std::size_t count, std::size_t rings);

}  // namespace yuragi::viewer::meshes
