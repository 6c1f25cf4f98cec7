#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "engine/base/simd_row.hpp"

namespace yuragi::operators {

/// The sampling operator "threshold ramp": shows a noise only where it exceeds a threshold that rises along an axis,
/// for a flame that dies out toward its top (Chiba, section 2-2 (2), figure 4b).
///
/// level = smooth((noise - threshold) / edge), threshold = first + (last - first) along, where smooth(t) goes from 0 at
/// t <= 0 to 1 at t >= 1 as t^2 (3 - 2 t): a soft edge, at most 1.5 / edge steep, so that nothing flickers. `along` is
/// each place's position on the axis: 0 at the first threshold, 1 at the last, above 1 beyond it. Owns nothing; `level`
/// may be `noise` itself, and overlaps nothing else. Thread-safe: jobs with different `level`, yes. Realtime-safe: yes.
/// Every SIMD row computes the same bits. Cost: about 0.3 ns a place (x86-64-v3).
struct ThresholdRampJob {
  std::span<const float> noise;
  std::span<const float> along;
  float first_threshold = 0.0F;
  float last_threshold = 1.0F;
  float edge = 0.25F;                         ///< over how much noise the level rises from 0 to 1: above 0
  std::optional<SimdRow> row = std::nullopt;  ///< unset: the widest that this machine can run

  std::span<float> level;  ///< 0 to 1

  enum class Problem : std::uint8_t {
    kNone,
    kSizesDiffer,
    kThresholdNotNumber,
    kEdge,  ///< not a number above 0
    kRowNotRunnable,
  };
  [[nodiscard]] Problem validate() const noexcept;

  /// Runs the job unless validate() finds a problem; returns the result of validate().
  Problem run() const noexcept;
};

}  // namespace yuragi::operators
