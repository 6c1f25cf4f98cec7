#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "engine/base/simd_row.hpp"
#include "engine/pose/skeleton.hpp"

namespace yuragi::operators {

/// How the threads of a cloth hang at rest: each a straight line from the fixed edge on, of links of one length. A lean
/// is the vector (east, south) of lean.hpp.
struct ClothThreads {
  std::size_t stride = 0;  ///< columns in whole blocks
  std::size_t links = 0;   ///< of a thread: the number of joints less one
  float link_length_m = 0.0F;
  std::vector<float> rest_lean;  ///< east of all columns, then south
  std::vector<float>
      rest_end_m;  ///< link_end of the leans: east of all columns, then down, then south; by make_threads
};

/// The threads that lean so (2 * stride values; stride a multiple of kStrandsPerBlock). Allocates.
ClothThreads make_threads(std::size_t links, float link_length_m, std::span<const float> rest_lean);

/// The projection of a cloth: gives each link the direction of its lean, and adds the links up from the fixed edge to
/// the joints' offsets, in GridPose's meaning. Links turn and do not stretch: threads keep their length to rounding
/// (about 1e-6). The leans of rest give exactly no offset, and the fixed edge stays at its offset.
///
/// A job does the links from first_link on, as many as `lean` has rows, and reads the joints above them from the pose:
/// so a cloth is computed from the fixed edge on, in bands that stay in the nearest cache. With first_link 0 it also
/// sets the fixed edge. World metres. Owns nothing; `pose` overlaps no input. Thread-safe: jobs with different poses,
/// yes. Realtime-safe: yes. Every SIMD row computes the same bits. Cost: about 0.5 ns a joint (x86-64-v3).
struct ClothProjectionJob {
  const ClothThreads* threads = nullptr;
  std::size_t first_link = 0;
  std::span<const float> lean;         ///< a row a link: east of all columns, then south, rest included; finite
  std::span<const float> edge_m = {};  ///< the fixed edge's offset from rest, x of all columns, then y, z; none: 0
  std::optional<SimdRow> row = std::nullopt;  ///< unset: the widest that this machine can run

  pose::GridPose* pose = nullptr;  ///< (links + 1) * stride joints

  enum class Problem : std::uint8_t {
    kNone,
    kMissingPart,  ///< no threads or no pose
    kThreadsSize,  ///< the stride is not in whole blocks, or an array of the threads has another size
    kLeanSize,     ///< not whole rows, or beyond the last link
    kEdgeSize,
    kPoseSize,
    kRowNotRunnable,
  };
  [[nodiscard]] Problem validate() const noexcept;

  /// Runs the job unless validate() finds a problem; returns the result of validate().
  Problem run() const noexcept;
};

}  // namespace yuragi::operators
