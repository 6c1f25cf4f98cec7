#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "engine/pose/skeleton.hpp"

namespace yuragi::viewer::meshes {

/// The shore of a pond: an irregular line within the rectangle of a level surface, a bank that goes up from it to the
/// ground, and a bed that goes down. The same surface always has the same shore. Pure.
class Shore {
 public:
  /// Depth of the water's surface below the ground.
  static constexpr float kSunk_m = 0.12F;

  /// No shore, everything is land: for a surface of less than two columns or rows.
  Shore() = default;
  explicit Shore(const pose::SurfaceSkeleton& surface);

  bool is_pond() const { return half_m_.x > 0.0F; }

  /// Approximate distance of a place (x, z) from the water, metres; negative in the water.
  float out_m(const glm::vec2& at_m) const;
  /// The width of the bank there: out_m() of its upper edge.
  float bank_m(const glm::vec2& at_m) const;
  /// The height of the bed or of the bank, above the ground.
  float bed_m(const glm::vec2& at_m) const;
  /// The height of waves there, relative to deep water.
  float wave_share(const glm::vec2& at_m) const;

  /// The place at a bearing (radians, relative to the surface's sides), at this distance from the water.
  glm::vec2 at(float bearing_rad, float out_m) const;

  /// The size of everything at the shore: 1 at a pond of 7 metres, less at a smaller one.
  float scale() const { return scale_; }
  const glm::vec2& middle_m() const { return middle_m_; }
  /// Unit vectors along the rows and the columns, and half of the rectangle's sides along them.
  const glm::vec2& along() const { return along_; }
  const glm::vec2& across() const { return across_; }
  const glm::vec2& half_m() const { return half_m_; }

 private:
  /// The shore's distance at a bearing, as a part of the rectangle's side.
  float reach(float bearing_rad) const;
  float bank_at(float bearing_rad) const;
  float bearing_of(const glm::vec2& off_m) const;

  glm::vec2 middle_m_{0.0F}, along_{1.0F, 0.0F}, across_{0.0F, 1.0F};
  glm::vec2 half_m_{0.0F};
  float scale_ = 0.0F;
  float turn_rad_ = 0.0F;  ///< another at each pond
};

/// A vertex of the bank, in the layout that the shader reads.
struct BankVertex {
  glm::vec3 place_m{0.0F};
  glm::vec3 normal{0.0F};
  float edge = 0.0F;  ///< 0 at the water, 1 at the upper edge of the bank
};

/// The bank, from a little below the water to a little under the ground around it, and the hole in the ground over it
/// and the water: its triangles come first. Empty without a pond.
struct BankMesh {
  std::vector<BankVertex> vertices;
  std::vector<std::uint32_t> hole;  ///< indices: to be drawn at the ground's height
  std::vector<std::uint32_t> bank;
};
BankMesh bank_of(const Shore& shore);

/// A reed at the shore, in the layout that the shader reads.
struct Reed {
  glm::vec3 root_m{0.0F};
  float length_m = 0.0F;
  float heading_rad = 0.0F;  ///< where it leans to
  float lean_rad = 0.0F;
  float width_m = 0.0F;
  float chance = 0.0F;  ///< random, 0 to 1: its look
};

/// In tufts that grow in groups along parts of the shore. Empty without a pond.
std::vector<Reed> reeds_of(const Shore& shore);

/// The slope of a pond's waves at each point of its grid, given the heights `y_m`: along x, along z, the sum of
/// both squares, and 0; four numbers per point, the texels of a texture.
class WaveSlopes {
 public:
  WaveSlopes(const pose::SurfaceSkeleton& surface, const Shore& shore);

  /// Takes the heights (a number for each point), makes waves lower toward the shore, and computes the slopes.
  void move_to(const float* y_m);
  const std::vector<float>& heights_m() const { return heights_m_; }
  const std::vector<float>& slopes() const { return slopes_; }

 private:
  std::size_t columns_, rows_;
  glm::vec2 along_per_m_, across_per_m_;  ///< factors from the difference of the two neighbours to a slope
  std::vector<float> share_, rest_y_m_;
  std::vector<float> heights_m_, slopes_;
};

}  // namespace yuragi::viewer::meshes
