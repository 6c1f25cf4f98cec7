#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "engine/pose/skeleton.hpp"

namespace yuragi::viewer::meshes {

/// The body of a flame as a volume: the heat of its points, streamed on a few nested shells, interpolated onto a box of
/// texels that bends with the rows. Pure; allocates when it is made, never afterwards.
///
/// A place in it is given by (x, z, v): metres east and south of the middle of its row, and the part of the way from
/// the foot to the top, up to kReach.
class FlameVolume {
 public:
  static constexpr std::size_t kAcross = 24;     ///< texels from east to west, and from north to south
  static constexpr std::size_t kMaxLayers = 96;  ///< rows that are more are left out evenly
  static constexpr std::size_t kHullSides = 12;
  static constexpr std::size_t kHullRings = 21;
  /// The axis continues straight above the top: gas that has left the flame flies there. It ends at this v.
  static constexpr float kReach = 1.9F;

  /// For a closed surface with a ramp; for any other it is empty.
  explicit FlameVolume(const pose::SurfaceSkeleton& surface);
  bool is_empty() const { return layers_ == 0; }

  /// Moves by the share `share` toward a pose that fits the skeleton (1: all of it).
  void move_to(const pose::SurfaceSkeleton& surface, const pose::SurfacePose& pose, float share = 1.0F);

  std::size_t layers() const { return layers_; }
  /// Layer after layer from the foot, row after row from the north, 0 to 255. A layer's texels cover the square of half
  /// its side `half_m` around the layer's middle.
  std::span<const std::uint8_t> heat() const { return heat_; }

  /// A layer's position in the world; two texels.
  struct Layer {
    glm::vec3 to_top_m{0.0F};  ///< how its middle changes with v
    float half_m = 0.0F;
    float slope_east = 0.0F, slope_south = 0.0F;              ///< downward, as in SurfacePose
    float slope_east_grows = 0.0F, slope_south_grows = 0.0F;  ///< with v
  };
  /// For all layers up to kReach: layers() of the flame itself, and those above it at the same spacing.
  std::span<const Layer> layer_rows() const { return rows_; }

  /// A closed skin around it, for its front to be drawn. After move_to() it is around all that the layers cover.
  struct HullVertex {
    glm::vec3 place_m{0.0F};  ///< in the world
    glm::vec3 inside{0.0F};   ///< (x, z, v)
  };
  std::span<const HullVertex> hull() const { return hull_; }
  std::span<const std::uint16_t> hull_indices() const { return indices_; }
  /// Shrinks the skin to these parts of the layers' half sides, evenly from the foot to kReach; zeros at the end are
  /// omitted.
  void wrap(std::span<const float> extents);

  /// The place in the world of (x, z, v).
  glm::vec3 place_m(float east_m, float south_m, float v) const;

  float height_m() const { return height_m_; }              ///< at rest
  float thickest_m() const { return thickest_m_; }          ///< the largest radius at rest
  float mean_heat() const { return mean_heat_; }            ///< mean of all points, 0 to 1
  glm::vec3 hot_middle_m() const { return hot_middle_m_; }  ///< of the heat

 private:
  std::size_t row_of(std::size_t layer) const;

  void wrap_to(float top_v, std::span<const float> extents);

  std::size_t layers_ = 0, rows_count_ = 0, shells_ = 0, around_ = 0;
  float height_m_ = 0.0F, thickest_m_ = 0.0F, mean_heat_ = 0.0F;
  glm::vec3 hot_middle_m_{0.0F};
  /// For a texel of a layer: the column before it, its position between that and the next, its distance from the
  /// middle.
  struct Texel {
    std::uint32_t column = 0;
    float part = 0.0F;
    float radius = 0.0F;  ///< the half side is 1
  };
  std::vector<Texel> texels_;
  std::vector<float> shell_parts_;   ///< radius of each shell, the outermost is 1
  std::vector<float> radius_, hot_;  ///< for all layers: shell after shell, one value per column
  std::vector<glm::vec3> middles_m_;
  std::vector<std::uint8_t> heat_;
  std::vector<Layer> rows_;
  std::vector<HullVertex> hull_;
  std::vector<std::uint16_t> indices_;
};

}  // namespace yuragi::viewer::meshes
