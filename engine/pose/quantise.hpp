#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "engine/base/simd_row.hpp"
#include "engine/pose/skeleton.hpp"

namespace yuragi::pose {

/// The value of one unit of a quantised bend: the range is +-pi in +-32767 units, so that rounding moves the tip of a 1
/// m blade by less than 0.1 mm.
inline constexpr float kBendStep_rad = 0x1.921fb6p1F / 32767.0F;

/// The same for the slope of a row: the range is +-4, steeper than any row.
inline constexpr float kSlopeStep = 4.0F / 32767.0F;

/// Angles (radians) to units of kBendStep_rad: rounded to the nearest, halves to even; values beyond +-pi become
/// +-32767, NaN becomes 0. Both spans have the same size and do not overlap. `row` is one that is_runnable(); unset:
/// the widest. Every row gives the same bits. Thread-safe and realtime-safe: yes. Cost: 0.04 to 0.2 ns a value.
void quantise(std::span<const float> angle_rad, std::span<std::int16_t> units,
              std::optional<SimdRow> row = std::nullopt) noexcept;

/// Ways (metres), or slopes, to units of step_m (above 0), in the same manner. Thread-safe and realtime-safe: yes.
void quantise_ways(std::span<const float> way_m, float step_m, std::span<std::int16_t> units,
                   std::optional<SimdRow> row = std::nullopt) noexcept;

/// Heat, 0 to 1, to 0 to 255, the number of a colour on the ramp, in the same manner. Thread-safe and realtime-safe:
/// yes.
void quantise_heat(std::span<const float> heat, std::span<std::uint8_t> units,
                   std::optional<SimdRow> row = std::nullopt) noexcept;

/// The value of one unit of a displacement, for a skeleton. The range is a multiple of its extent at rest: twice for a
/// cloth (one of 2 m by 2 m is within 0.09 mm) and for a closed surface, which can lean; a quarter for an open one,
/// where small waves are visible (8 m by 8 m of water are within 0.05 mm). The extent is the diagonal of a box around
/// some of its points, the corners among them, so that this takes as long for every size. Thread-safe and
/// realtime-safe: yes.
float way_step_m(const GridSkeleton& grid) noexcept;
float way_step_m(const SurfaceSkeleton& surface) noexcept;

}  // namespace yuragi::pose
