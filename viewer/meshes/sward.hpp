#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "viewer/meshes/view.hpp"

namespace yuragi::viewer::meshes {

/// How a stand of grass gets thinner with the distance from the eye: every blade has a rank from 0 to 1, and is drawn
/// while its rank is below share(). Those that are left are wider. The shaders have the same law (kept_share() in
/// blade.part.glsl).
struct Thinning {
  float blades_per_m2 = 200.0F;     ///< of the whole stand
  float drawn_at_1m_per_m2 = 0.0F;  ///< the most that are drawn at a distance of 1 m; falls with its power -1.5

  float factor() const { return drawn_at_1m_per_m2 / blades_per_m2; }
  float share(float distance_m) const;
};

/// How many blades are drawn. The fewer, the nearer to the eye blades are left out and the others drawn wider.
inline constexpr float kManyBladesAt1m_per_m2 = 24'000.0F;
inline constexpr float kSomeBladesAt1m_per_m2 = 8'000.0F;
inline constexpr float kFewBladesAt1m_per_m2 = 3'500.0F;

/// A blade of the tile that the sward is laid of, as the shader reads it.
struct SwardBlade {
  float x = 0.0F, z = 0.0F;  ///< on the tile, 0 to 1
  float facing_rad = 0.0F;   ///< bearing of its flat side
  float height = 1.0F;       ///< as a part of the mean
  float heading_rad = 0.0F;  ///< where it droops to
  float chance = 0.0F;       ///< 0 to 1: its tint, and what grows on it
  float droop = 1.0F;        ///< how far, as a part of the mean
  float sway = 1.0F;         ///< how far the wind bends it, as a part of what it bends the ground's nodes
};

/// `count` blades, evenly scattered, in the order of their ranks: blade i has rank (i + 0.5) / count, and any first
/// part of them is scattered evenly, too. Always the same.
std::vector<SwardBlade> sward_blades(std::size_t count);

/// A tile of the sward that is in view.
struct SwardTile {
  glm::vec2 origin_m{0.0F};  ///< its north-western corner
  float turn = 0.0F;         ///< 0 to 7: by how many quarters it is turned, and whether it is mirrored
  float blades = 0.0F;       ///< how many of its first ones are drawn
};

/// Lays tiles around the eye and chooses those in view. Pure; does not allocate after the first few pictures.
class SwardTiles {
 public:
  static constexpr float kTile_m = 5.0F;
  /// From these distances on a blade has fewer rings of vertices; kRings of them.
  static constexpr std::size_t kLevels = 3;
  static constexpr std::array<std::size_t, kLevels> kRings{4, 2, 1};
  static constexpr std::array<float, kLevels> kFrom_m{0.0F, 5.0F, 20.0F};

  /// Tiles of the whole stand have `blades` each; none is laid farther than `reach_m` from the eye.
  SwardTiles(std::size_t blades, const Thinning& thinning, float reach_m)
      : blades_(blades), thinning_(thinning), reach_m_(reach_m) {}

  /// `height_m`: no blade reaches higher.
  void choose(const View& view, float height_m);

  /// Of a level of detail.
  std::span<const SwardTile> level(std::size_t level) const { return levels_[level]; }

 private:
  std::size_t blades_;
  Thinning thinning_;
  float reach_m_;
  std::array<std::vector<SwardTile>, kLevels> levels_;
};

/// The triangles of `count` ribbons of so many rings, of 2 rings + 1 vertices each, one ribbon behind the other.
std::vector<std::uint32_t> ribbon_triangles(std::size_t count, std::size_t rings);

}  // namespace yuragi::viewer::meshes
