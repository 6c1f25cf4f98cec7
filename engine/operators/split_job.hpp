#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "engine/base/simd_row.hpp"

namespace yuragi::operators {

/// The threshold split: one noise becomes two, its part above a threshold and its part below (Chiba, section 3.3: for a
/// tree's branches the first drives the vertical motion, the second the horizontal one).
///
/// The threshold rises along a ramp, threshold + threshold_rise * ramp[i]. A change of the noise goes to `above` in the
/// share of a smooth step around the threshold, `width` wide, and the rest to `below`; a noise of 0 is (0, 0). So the
/// sum is the noise, both parts rise with it but never faster, and no place flips between the two (engine/METHOD.md
/// M30, D6). A moving ramp moves the parts by at most as much as the threshold. All spans have the same size; the
/// outputs overlap nothing else. Owns nothing. Thread-safe: jobs with different outputs, yes. Realtime-safe: yes. Every
/// SIMD row computes the same bits. Cost: about 1 ns an element (x86-64-v3).
struct SplitJob {
  std::span<const float> noise;
  std::span<const float> ramp;
  double threshold = 0.0;
  double threshold_rise = 0.0;
  double width = 1.0;                         ///< 1e-6 to 1e6
  std::optional<SimdRow> row = std::nullopt;  ///< unset: the widest that this machine can run

  std::span<float> above;
  std::span<float> below;

  enum class Problem : std::uint8_t {
    kNone,
    kThresholdNotFinite,  ///< or its rise
    kWidth,               ///< not a number from 1e-6 to 1e6
    kSizesDiffer,
    kRowNotRunnable,
  };
  [[nodiscard]] Problem validate() const noexcept;

  /// Runs the job unless validate() finds a problem; returns the result of validate().
  Problem run() const noexcept;
};

}  // namespace yuragi::operators
