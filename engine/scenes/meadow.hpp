#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "engine/pose/skeleton.hpp"

namespace yuragi::scenes {

/// Parameters of a meadow.
struct MeadowSpec {
  std::size_t blades_across = 100;    ///< along x
  std::size_t blades_deep = 100;      ///< along z
  std::size_t links = 10;             ///< a blade
  double width_m = 7.0;               ///< along x
  double depth_m = 7.0;               ///< along z
  double length_m = 0.7;              ///< mean length of a blade
  double length_variation = 0.25;     ///< standard deviation, as a part of length_m
  double tilt_deg = 8.0;              ///< mean angle of a blade's foot from upright
  double curl_deg = 35.0;             ///< from foot to tip, mean
  double heading_deg = 0.0;           ///< mean direction in which blades droop, clockwise from north
  double heading_spread_deg = 150.0;  ///< standard deviation around it
  std::uint64_t seed = 0;
};

/// Blades of grass, and how easily each is bent.
struct Meadow {
  pose::StrandSkeleton skeleton;
  std::vector<float> flexibility;  ///< 1 on average, more for longer ones; padded_count() elements
};

/// Creates the layout of a meadow around the world's origin, on the ground y = 0: place, length, heading, tilt and curl
/// of each blade come from 2-D noises of a small beta and a large scale, so that neighbours differ and yet patches show
/// (Chiba, section 3.1). Rows along x, from north to south, each from west to east. Deterministic by seed. Allocates;
/// may throw std::bad_alloc, and std::invalid_argument for more than 4096 blades along an edge. Thread-safe: yes.
/// Realtime-safe: no.
Meadow make_meadow(const MeadowSpec& spec);

}  // namespace yuragi::scenes
