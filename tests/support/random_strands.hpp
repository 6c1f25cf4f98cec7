#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>

#include "engine/math/philox.hpp"
#include "engine/pose/skeleton.hpp"

namespace yuragi {

/// Strands of every kind: any rest direction and curl direction, 1 m long in all, curled by up to `curl_rad` a link.
/// All roots are the origin, so that lengths are not lost in the rounding of places far away.
inline pose::StrandSkeleton random_strands(std::size_t strands, std::size_t links, double curl_rad,
                                           std::uint64_t seed) {
  const math::RandomStream random(seed, math::stream_id("random strands"));
  pose::StrandSkeleton skeleton;
  skeleton.strand_count = strands;
  skeleton.links_per_strand = links;
  for (std::size_t i = 0; i < skeleton.padded_count(); ++i) {
    // A direction on the sphere, one across it, and that one turned about it.
    const double height = 2.0 * random.uniform(4 * i) - 1.0;
    const double around = 2.0 * std::numbers::pi * random.uniform(4 * i + 1);
    const double turn = 2.0 * std::numbers::pi * random.uniform(4 * i + 2);
    const double flat = std::sqrt(1.0 - height * height);
    const double rest[3] = {flat * std::cos(around), height, flat * std::sin(around)};
    const double level[3] = {-std::sin(around), 0.0, std::cos(around)};
    const double rising[3] = {-height * std::cos(around), flat, -height * std::sin(around)};
    const auto across = [&](int axis) {
      return static_cast<float>(std::cos(turn) * level[axis] + std::sin(turn) * rising[axis]);
    };
    skeleton.rest_x.push_back(static_cast<float>(rest[0]));
    skeleton.rest_y.push_back(static_cast<float>(rest[1]));
    skeleton.rest_z.push_back(static_cast<float>(rest[2]));
    skeleton.curl_x.push_back(across(0));
    skeleton.curl_y.push_back(across(1));
    skeleton.curl_z.push_back(across(2));
    skeleton.rest_curl_rad.push_back(static_cast<float>(curl_rad * random.uniform(4 * i + 3)));
    skeleton.root_x_m.push_back(0.0F);
    skeleton.root_y_m.push_back(0.0F);
    skeleton.root_z_m.push_back(0.0F);
    skeleton.link_length_m.push_back(1.0F / static_cast<float>(links));
  }
  return skeleton;
}

/// Bends toward all directions, up to `largest_rad`.
inline pose::StrandPose random_bends(const pose::StrandSkeleton& skeleton, double largest_rad, std::uint64_t seed) {
  const math::RandomStream random(seed, math::stream_id("random bends"));
  pose::StrandPose pose;
  for (std::size_t i = 0; i < skeleton.padded_count(); ++i) {
    const double angle = largest_rad * random.uniform(2 * i);
    const double around = 2.0 * std::numbers::pi * random.uniform(2 * i + 1);
    pose.bend_east_rad.push_back(static_cast<float>(angle * std::cos(around)));
    pose.bend_south_rad.push_back(static_cast<float>(angle * std::sin(around)));
  }
  return pose;
}

}  // namespace yuragi
