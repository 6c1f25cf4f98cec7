#pragma once

#include <cstddef>

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "viewer/meshes/bounds.hpp"
#include "viewer/meshes/trees/tree_place.hpp"
#include "viewer/meshes/view.hpp"

namespace yuragi::viewer::meshes::trees {

// Far away a tree is drawn as an impostor: a picture of it at rest, on an upright sheet that faces the eye. It is seen
// from kImpostorSides sides, each from kImpostorRows heights (impostor.vert.glsl has the same numbers).

inline constexpr std::size_t kImpostorSides = 8;  ///< the first from the south, the next from the south-east
inline constexpr std::size_t kImpostorRows = 3;
inline constexpr float kMinImpostor_rad = 0.07F;   ///< how high above the horizon the lowest row is seen from
inline constexpr float kImpostorStep_rad = 0.63F;  ///< and how much higher each next one

/// The part of a tree that its pictures show.
struct ImpostorBox {
  glm::vec3 middle_m{0.0F};
  float half_width_m = 1.0F;
  float half_height_m = 1.0F;
};
ImpostorBox impostor_box(const Bounds& tree);

/// The view of such a picture, `side_px` pixels wide and high. Without perspective.
View impostor_view(const ImpostorBox& box, std::size_t side, std::size_t row, int side_px);

/// An impostor's position, in the shader's layout.
struct Impostor {
  glm::vec4 foot_scale{0.0F};  ///< metres
  glm::vec4 turn_sway{0.0F};   ///< cosine and sine; how far its middle is blown toward east and south, metres
  float share = 1.0F;          ///< share of its pixels that are drawn
  float hanging = 1.0F;        ///< of its leaves
  float chance = 0.5F;         ///< Place::chance()
};

/// The drawn share of the impostor of a tree of this height: 0 near by, 1 from `largest_px` on. In between it fades in
/// over the tree.
float impostor_share(float height_px, float largest_px);

}  // namespace yuragi::viewer::meshes::trees
