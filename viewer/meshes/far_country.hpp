#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <glm/vec3.hpp>

namespace yuragi::viewer::meshes {

/// The surroundings of the meadow, around the world's middle: copses, the edge of a wood, wooded hills, farther hills,
/// mountains; each an upright wall all around, from fixed random numbers. Their patterns do not repeat around the
/// circle.
struct FarRange {
  float distance_m;         ///< mean
  float distance_varies_m;  ///< amplitude of the variation, both ways
  float land_m;             ///< height of the land
  float trees_m;            ///< size of its trees; 0: none can be distinguished
};
inline constexpr std::array<FarRange, 5> kFarRanges{{{580.0F, 170.0F, 0.0F, 13.0F},
                                                     {1150.0F, 150.0F, 9.0F, 17.0F},
                                                     {2700.0F, 0.0F, 120.0F, 15.0F},
                                                     {5600.0F, 0.0F, 390.0F, 0.0F},
                                                     {13000.0F, 0.0F, 1150.0F, 0.0F}}};

/// A corner of a range's wall, as the shader reads it (hills.vert.glsl).
struct FarCorner {
  glm::vec3 top_m{0.0F};
  float along_m = 0.0F;  ///< along the circle, from north over east
};

inline constexpr int kFarCorners = 8640;  ///< around the circle

/// The upper corners of a range's wall, at even bearings; the last one repeats the first, and then half of the circle
/// is repeated.
std::vector<FarCorner> far_corners(std::size_t range);

/// The step between drawn corners for which those in the picture are at least about `apart_rad` apart. It divides
/// kFarCorners.
int far_corner_step(float apart_rad);

}  // namespace yuragi::viewer::meshes
