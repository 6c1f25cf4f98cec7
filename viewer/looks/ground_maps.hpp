#pragma once

#include <vector>

#include "engine/pose/skeleton.hpp"
#include "viewer/gl/gl.hpp"
#include "viewer/meshes/ground_map.hpp"
#include "viewer/meshes/meadow_waves.hpp"

namespace yuragi::viewer::looks {

/// What the shaders know of the ground: the uniform block Ground, the grid of bends, the map of growth and a noise, on
/// texture units of their own. Needs a current context.
class GroundMaps {
 public:
  GroundMaps();

  /// Tells a program where its samplers find them.
  static void set_samplers(const gl::Program& program);

  /// What stands on the ground, and how tall grass may grow anywhere, 0 to 1. The map is made anew where that has
  /// changed.
  void set_standing(const std::vector<meshes::Standing>& things, float most_growth = 1.0F);
  /// Before move_to(): the moment of the picture, and the wind toward east and south.
  void set_moment(double time_s, const glm::vec2& wind_m_s) { waves_.advance_to(time_s, wind_m_s); }
  /// The bends of the picture. `grid`: of the nodes of the ground. If there are none, MeadowWaves bend the grass, on
  /// the average by that share as `near_by`, and else as the wind does.
  void move_to(const meshes::BendGrid& grid, const pose::StrandPose* nodes, const pose::StrandPose* near_by,
               float near_by_share);
  const meshes::GrowthMap& growth() const { return map_; }
  /// How far grass is bent by the streamed ground at a place (x, z) in the picture, and on average: east, south,
  /// radians. As bend_at() in sward.part.glsl, but MeadowWaves count as the mean: they are for the eye alone.
  glm::vec2 bend_at(const glm::vec2& at_m) const;
  glm::vec2 mean_bend() const { return glm::vec2(ground_.bend_mean); }
  /// Binds all of it, with this stand of tall grass, of which the share `tall` is to be seen, through the door of this
  /// number.
  void bind(const meshes::Stand& stand, float tall, std::size_t door);

 private:
  gl::Texture noise_, turf_, bends_, growth_;
  gl::Buffer block_;
  meshes::Ground ground_;
  meshes::GrowthMap map_;
  std::vector<meshes::Standing> standing_;
  float most_growth_ = 1.0F;
  std::vector<glm::vec2> texels_;
  std::size_t columns_ = 1, rows_ = 1;  // of texels_
  meshes::MeadowWaves waves_;
};

}  // namespace yuragi::viewer::looks
