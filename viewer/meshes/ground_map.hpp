#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec4.hpp>

#include "engine/pose/skeleton.hpp"
#include "viewer/meshes/bounds.hpp"
#include "viewer/meshes/floor.hpp"
#include "viewer/meshes/shore.hpp"

namespace yuragi::viewer::meshes {

/// The uniform block Ground of viewer/gl/shaders/sward.part.glsl, in its layout (std140).
struct Ground {
  glm::vec4 bends_place{0.0F};  ///< x, z of the corner of the grid of bends, metres; z: 1 if the grid is of
                                ///< MeadowWaves, 0 if it is streamed; of no use
  glm::vec4 bends_axes{
      0.0F};  ///< a matrix, column by column: from metres behind that corner to parts of the grid's sides
  glm::vec4 bend_mean{0.0F};                 ///< east, south, radians; unused; w: share of tall grass
  glm::vec4 growth_place{0.0F};              ///< x, z of the low corner of the map of growth, metres; 1 / its sides
  glm::vec4 stand{0.6F, 0.6F, 0.0F, 0.14F};  ///< tall grass: mean length, metres; curl, radians; number of the
                                             ///< ScreenDoor through which it fades; tilt, radians
};

/// The properties of a stand of streamed blades.
struct Stand {
  float length_m = 0.6F;  ///< mean
  float curl_rad = 0.6F;  ///< mean, from foot to tip, at rest
  float tilt_rad = 0.14F;
  float blades_per_m2 = 200.0F;
};
Stand stand_of(const pose::StrandSkeleton& skeleton);

/// A grid of bends over the ground: strands in rows of `columns`, with even spacings.
struct BendGrid {
  std::size_t columns = 0, rows = 0;  ///< 0: there is none
  glm::vec2 first_m{0.0F};            ///< x, z of the first node
  glm::vec2 to_next_m{1.0F, 0.0F};    ///< from a node to the next one in its row
  glm::vec2 to_next_row_m{0.0F, 1.0F};
};
/// The grid on which the strands stand; nullopt if there is none.
BendGrid bend_grid_of(const pose::StrandSkeleton& skeleton);

/// A thing on the ground, and its visible share (0 to 1).
struct Standing {
  enum class Kind : std::uint8_t { kGrass, kWater, kFur, kFire, kOther };
  Kind kind = Kind::kOther;
  Bounds bounds;
  float opacity = 1.0F;
  const pose::StrandSkeleton* blades = nullptr;  ///< of grass
  std::optional<Floor> floor = std::nullopt;     ///< that it stands on
  const Shore* shore = nullptr;                  ///< of water; null: it fills its box
};

/// How tall grass grows, and where the ground is taken, by streamed blades: a square map around the middle of the
/// scenes, row after row from the north-west, three bytes a texel. Grass is short around other things, up to an
/// irregular border that is the same for the same things, trampled around a fire, and reaches up to fur. On water and
/// floors there are no blades. Beyond the map its edge values continue.
class GrowthMap {
 public:
  static constexpr std::size_t kTexels = 256;  ///< a side
  static constexpr float kSide_m = 128.0F;

  GrowthMap();
  /// `most`: how tall grass may grow anywhere, 0 to 1.
  void make(std::span<const Standing> things, float most = 1.0F);
  std::span<const std::uint8_t> texels() const { return texels_; }
  /// 0 to 1, at the texel of a place on the map.
  float growth_at(float x_m, float z_m) const;
  float blades_at(float x_m, float z_m) const;
  float water_at(float x_m, float z_m) const;
  /// Returns true if a blade that is not streamed can stand in this rectangle (x, z): not on water, nor, if it is tall
  /// grass, among streamed blades.
  bool is_free(const glm::vec2& low_m, const glm::vec2& high_m, bool is_tall) const;

 private:
  std::vector<std::uint8_t> texels_;
  std::vector<float> growth_, blades_, water_;
  std::vector<float> wander_m_;  ///< how far a lawn's border is out beyond its margin, at each texel
};

}  // namespace yuragi::viewer::meshes
