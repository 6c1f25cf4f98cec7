#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "engine/pose/skeleton.hpp"
#include "viewer/meshes/body.hpp"
#include "viewer/meshes/bounds.hpp"
#include "viewer/meshes/view.hpp"

namespace yuragi::viewer::meshes {

/// The data of a strand, in the layout of the shader of hair: three texels.
struct Blade {
  std::array<float, 3> root_m{};
  float width_m = 0.0F;
  std::array<float, 3> tint{};  ///< of its tip, linear light
  float facing_rad = 0.0F;      ///< bearing of its flat side
  float strand = 0.0F;          ///< its number, an integer
  float length_m = 0.0F;
  float opening = 0.0F;  ///< how far the coat parts there (partings.hpp)
  float unused = 0.0F;
};

/// A blade (or hair) for each strand: wide enough for the strands' spacing to cover the ground, tinted like a coat, by
/// patches and at random (grass is colored by its shader). The same skeleton always gives the same blades.
std::vector<Blade> blades_of(const pose::StrandSkeleton& skeleton);

/// Blades of one level of detail.
struct DetailLevel {
  std::size_t rings = 1;      ///< rings of vertices above the root; at most one per link
  bool is_far = false;        ///< they are so small that one ribbon per strand suffices
  std::vector<Blade> blades;  ///< in view
};

/// Sorts blades by their size in the picture: a large one gets a ring of vertices per link, a small one fewer. Omitted
/// are blades outside the picture, those hidden by a body (body.hpp), and an increasing share of the very small ones,
/// the others being wider instead. Pure; does not allocate once it has seen all blades in each level.
class BladeSorter {
 public:
  static constexpr float kRingPx = 22.0F;      ///< a ring for each of this many pixels of a blade's height
  static constexpr std::size_t kMinRings = 3;  ///< if there are as many links
  static constexpr float kFarPx = 20.0F;       ///< smaller ones are far; hair.vert.glsl has the same number
  static constexpr float kTinyPx = 8.0F;       ///< of smaller ones, half or fewer are drawn
  static constexpr float kFewest = 1.0F / 32.0F;
  static constexpr std::size_t kFarRings = 2;

  explicit BladeSorter(const pose::StrandSkeleton& skeleton);

  void sort(const View& view);

  /// Partings', a strand each.
  void set_openings(std::span<const float> openings);

  /// Near ones first.
  std::span<const DetailLevel> levels() const { return levels_; }

 private:
  std::vector<Blade> blades_;
  Body body_;
  std::vector<DetailLevel> levels_;
};

}  // namespace yuragi::viewer::meshes
