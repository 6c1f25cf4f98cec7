#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "engine/pose/skeleton.hpp"
#include "viewer/meshes/body.hpp"

namespace yuragi::viewer::meshes {

/// A point of the short-haired parts of an animal.
struct LimbVertex {
  glm::vec3 place_m{0.0F};
  glm::vec3 normal{0.0F};
  glm::vec3 tint{0.0F};     ///< linear light
  glm::vec2 hair_m{0.0F};   ///< place on the limb: along its hairs, and across them
  glm::vec3 lie{0.0F};      ///< the way that its hairs lie, before they are laid onto the skin
  float radius_m = 0.0F;    ///< of the limb there
  glm::vec3 aside_m{0.0F};  ///< of a hair: from its middle line to here
};

/// Triangles: of the skin first, `skin_count` indices, and then of the hairs on it, one each; any first part of them is
/// spread over the whole skin.
struct Limbs {
  std::vector<LimbVertex> vertices;
  std::vector<std::uint32_t> indices;
  std::size_t skin_count = 0;
  float hair_m = 0.0F;  ///< the longest hair
};

/// What a sleeping animal has besides the coat on its body: neck and head on the forepaws, ears, haunches and hind
/// paws, a tail along its side. The head is where the hairs lie away from. A short coat
/// stands on them all, so that no outline is smooth. Empty for a body that is no animal as a
/// whole, but a part of one that fills the picture: one that is less than 1.8 times as long as it is wide, or no
/// ellipsoid. Pure.
Limbs limbs_of(const pose::StrandSkeleton& coat, const Body& body);

}  // namespace yuragi::viewer::meshes
