#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "engine/base/simd_row.hpp"

namespace yuragi::operators {

/// A color ramp: this many colors of 4 bytes (red, green, blue, alpha).
inline constexpr std::size_t kRampColors = 256;

/// The projection operator "color mapping": a level indexes a color ramp (Chiba, section 2-2 (3)).
///
/// Level 0 has the ramp's first color, 1 its last, between them the nearest; below 0 counts as 0, above 1 as 1, and
/// what is no number as 0. Owns nothing; `rgba` overlaps nothing else. Thread-safe: jobs with different `rgba`, yes.
/// Realtime-safe: yes. Every SIMD row computes the same bits. Cost: about 1.4 ns a level (x86-64-v3).
struct ColorMapJob {
  std::span<const float> level;
  std::span<const std::uint8_t> ramp_rgba;    ///< 4 * kRampColors bytes, as SurfaceSkeleton::ramp_rgba
  std::optional<SimdRow> row = std::nullopt;  ///< unset: the widest that this machine can run

  std::span<std::uint8_t> rgba;  ///< 4 bytes a level

  enum class Problem : std::uint8_t {
    kNone,
    kRampSize,
    kSizesDiffer,
    kRowNotRunnable,
  };
  [[nodiscard]] Problem validate() const noexcept;

  /// Runs the job unless validate() finds a problem; returns the result of validate().
  Problem run() const noexcept;
};

}  // namespace yuragi::operators
