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
  glm::vec3 lie{0.0F};      ///< direction of its hairs, before they are laid onto the skin
  float radius_m = 0.0F;    ///< of the limb there
  glm::vec3 aside_m{0.0F};  ///< of a hair: from its middle line to here
};

/// Triangles: first the skin's, `skin_count` indices, then one per hair; any first part of these is spread over the
/// whole skin.
struct Limbs {
  std::vector<LimbVertex> vertices;
  std::vector<std::uint32_t> indices;
  std::size_t skin_count = 0;
  float hair_m = 0.0F;  ///< the longest hair
};

/// The parts of a sleeping animal besides its body: neck and head on the forepaws, ears, haunches and hind paws, a tail
/// along its side. The hairs lie away from the head. All parts have a short coat, so that no outline is smooth. Empty
/// if the body is not a whole animal, but a part that fills the picture: less than 1.8 times as long as wide, or no
/// ellipsoid. Pure.
Limbs limbs_of(const pose::StrandSkeleton& coat, const Body& body);

}  // namespace yuragi::viewer::meshes
