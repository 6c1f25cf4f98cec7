#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <glm/vec3.hpp>

namespace yuragi::viewer::meshes {

/// What stands around the meadow, around the world's middle: copses, the edge of a wood, wooded hills, farther hills,
/// mountains; each an upright wall all around, by random numbers that are always the same. No pattern of theirs comes
/// back on the way around.
struct FarRange {
  float distance_m;         ///< mean
  float distance_varies_m;  ///< by so much, both ways
  float land_m;             ///< height of the land
  float trees_m;            ///< of the trees on it; 0: none can be distinguished
};
inline constexpr std::array<FarRange, 5> kFarRanges{{{580.0F, 170.0F, 0.0F, 13.0F},
                                                     {1150.0F, 150.0F, 9.0F, 17.0F},
                                                     {2700.0F, 0.0F, 120.0F, 15.0F},
                                                     {5600.0F, 0.0F, 390.0F, 0.0F},
                                                     {13000.0F, 0.0F, 1150.0F, 0.0F}}};

/// A corner of a range's wall, as the shader reads it (hills.vert.glsl).
struct FarCorner {
  glm::vec3 top_m{0.0F};
  float along_m = 0.0F;  ///< on the way around, from north over east
};

inline constexpr int kFarCorners = 8640;  ///< around the circle

/// The upper corners of a range's wall, at even bearings; the last one is the first one again, and after it comes as
/// much as half of the way around once more.
std::vector<FarCorner> far_corners(std::size_t range);

/// Every how manieth corner is to be drawn so that those in the picture are at least about so far apart; radians. It
/// divides kFarCorners.
int far_corner_step(float apart_rad);

}  // namespace yuragi::viewer::meshes
