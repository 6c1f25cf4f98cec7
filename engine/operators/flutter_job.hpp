#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "engine/base/simd_row.hpp"

namespace yuragi::operators {

/// The projection operator of leaves: each leans with the wind at its spray, as far as its petiole yields, and flutters
/// across its own axis by its noise (Chiba, section 3.3). The bend, in StrandPose's meaning, is give lean + flutter
/// noise axis, with lean and flutter of LeafResponseJob. Sprays are of kLeavesOfASpray leaves each, which follow one
/// another. Radians. The spans of the leaves have the same size, as do those of the places; the outputs overlap nothing
/// else. Owns nothing. Thread-safe: jobs with different outputs, yes. Realtime-safe: yes. Every SIMD row computes the
/// same bits. Cost: about 0.5 ns a leaf (x86-64-v3).
struct FlutterJob {
  static constexpr std::size_t kLeavesOfASpray = 16;

  std::span<const float> lean_east_rad;  ///< in each place
  std::span<const float> lean_south_rad;
  std::span<const float> flutter_rad;    ///< for a noise of 1
  std::span<const std::uint32_t> place;  ///< of each spray
  std::span<const float> noise;          ///< at each leaf
  std::span<const float> give;           ///< of its petiole
  std::span<const float> axis_east;  ///< direction of the bend for a positive noise; its length is the leaf's activity
  std::span<const float> axis_south;
  std::optional<SimdRow> row = std::nullopt;  ///< unset: the widest that this machine can run

  std::span<float> bend_east_rad;
  std::span<float> bend_south_rad;

  enum class Problem : std::uint8_t {
    kNone,
    kSizesDiffer,  ///< or the number of leaves is not a multiple of a spray's
    kPlace,        ///< index of a spray that does not exist
    kRowNotRunnable,
  };
  [[nodiscard]] Problem validate() const noexcept;

  /// Runs the job unless validate() finds a problem; returns the result of validate().
  Problem run() const noexcept;
};

}  // namespace yuragi::operators
