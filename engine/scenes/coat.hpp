#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "engine/pose/skeleton.hpp"

namespace yuragi::scenes {

/// Parameters of a coat of fur, and of the body under it: the upper half of an ellipsoid that lies along x, like the
/// back of an animal that sleeps in the grass.
struct CoatSpec {
  std::size_t hairs_along = 200;   ///< rows from one end of the body to the other
  std::size_t hairs_around = 150;  ///< in each row, from the ground over the back to the ground
  std::size_t links = 10;          ///< a hair
  double body_length_m = 3.0;
  double body_height_m = 0.75;
  double body_width_m = 2.0;
  double length_m = 0.09;         ///< mean length of a hair
  double length_variation = 0.2;  ///< standard deviation, relative to it
  double lie_deg = 55.0;          ///< angle of a hair's foot from the body's normal
  double curl_deg = 30.0;         ///< how much farther it curls to its tip
  double parting_deg = 20.0;      ///< standard deviation of the hairs' direction
  std::uint64_t seed = 0;
};

/// Hairs on a body, the place at which each reads the wind, and its flexibility.
struct Coat {
  pose::StrandSkeleton skeleton;
  std::vector<float> place_x_m, place_z_m;  ///< on the body, unrolled: along it, and around it from its ridge to +z
  std::vector<float> normal_x, normal_z;    ///< of the skin, outward
  std::vector<float> flexibility;           ///< mean 1. padded_count() elements, like all here
};

/// Creates the layout of a coat. Hairs are spread evenly, lie toward -x and down the flanks, and differ by 2-D noises
/// of a large beta and a small scale, so that neighbours form locks (Chiba, section 3.1). Deterministic by seed.
/// Allocates; may throw std::bad_alloc, and std::invalid_argument for more than 4096 hairs along or around.
/// Thread-safe: yes.
Coat make_coat(const CoatSpec& spec);

}  // namespace yuragi::scenes
