#pragma once

#include <cstdint>
#include <span>

namespace yuragi {

/// What one unit of a quantised bend is worth: the range is +-pi in +-32767 units, so that rounding moves the tip of a
/// 1 m blade by less than 0.1 mm.
inline constexpr float kBendStep_rad = 0x1.921fb6p1F / 32767.0F;

/// Angles (radians) to units of kBendStep_rad: rounded to the nearest, halves to even; what is beyond +-pi becomes
/// +-32767, NaN becomes 0. Both spans have the same size. Thread-safe and realtime-safe: yes.
void quantise(std::span<const float> angle_rad, std::span<std::int16_t> units) noexcept;

/// And back. Both spans have the same size. Thread-safe and realtime-safe: yes.
void dequantise(std::span<const std::int16_t> units, std::span<float> angle_rad) noexcept;

}  // namespace yuragi
