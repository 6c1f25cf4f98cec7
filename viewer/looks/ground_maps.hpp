#pragma once

#include <vector>

#include "engine/pose/skeleton.hpp"
#include "viewer/gl/gl.hpp"
#include "viewer/meshes/ground_map.hpp"
#include "viewer/meshes/meadow_waves.hpp"

namespace yuragi::viewer::looks {

/// The shaders' data about the ground: the uniform block Ground, the grid of bends, the map of growth and a noise, on
/// texture units of their own. Needs a current context.
class GroundMaps {
 public:
  GroundMaps();

  /// Sets the texture units of a program's samplers.
  static void set_samplers(const gl::Program& program);

  /// Takes the things on the ground, and how tall grass can grow anywhere, 0 to 1. The map is made again if they have
  /// changed.
  void set_standing(const std::vector<meshes::Standing>& things, float most_growth = 1.0F);
  /// Before move_to(): the moment of the picture, and the wind toward east and south.
  void set_moment(double time_s, const glm::vec2& wind_m_s) { waves_.advance_to(time_s, wind_m_s); }
  /// Takes the bends of the picture. `grid`: of the nodes of the ground. If there are none, MeadowWaves bend the grass;
  /// `near_by_share` of their mean is that of `near_by`, the rest follows the wind.
  void move_to(const meshes::BendGrid& grid, const pose::StrandPose* nodes, const pose::StrandPose* near_by,
               float near_by_share);
  const meshes::GrowthMap& growth() const { return map_; }
  /// How far the streamed ground bends grass at a place (x, z) in the picture, and on average: east, south, radians.
  /// Like bend_at() in sward.part.glsl, but MeadowWaves count as their mean: they are only visual.
  glm::vec2 bend_at(const glm::vec2& at_m) const;
  glm::vec2 mean_bend() const { return glm::vec2(ground_.bend_mean); }
  /// Binds all of it, with this stand of tall grass, of which the share `tall` is visible, through the door of this
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
