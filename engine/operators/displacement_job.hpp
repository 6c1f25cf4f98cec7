#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "engine/base/simd_row.hpp"

namespace yuragi::operators {

/// The projection operator "displacement": a noise moves points along a direction, here their normals, as
/// SurfacePose::displacement_m (Chiba, section 2-2 (3)).
///
/// displacement = amplitude * share * noise: `share` is each point's own factor (0 holds a point in place). An
/// amplitude of 0 gives 0 for any finite noise. Metres. Owns nothing; `displacement_m` may be `noise` itself, and
/// overlaps nothing else. Thread-safe: jobs with different outputs, yes. Realtime-safe: yes. Every SIMD row computes
/// the same bits. Cost: about 0.1 ns a point (x86-64-v3).
struct DisplacementJob {
  std::span<const float> noise;
  std::span<const float> share;
  double amplitude_m = 0.0;
  std::optional<SimdRow> row = std::nullopt;  ///< unset: the widest that this machine can run

  std::span<float> displacement_m;

  enum class Problem : std::uint8_t {
    kNone,
    kAmplitudeNotNumber,
    kSizesDiffer,
    kRowNotRunnable,
  };
  [[nodiscard]] Problem validate() const noexcept;

  /// Runs the job unless validate() finds a problem; returns the result of validate().
  Problem run() const noexcept;
};

}  // namespace yuragi::operators
