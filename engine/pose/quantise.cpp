#include "engine/pose/quantise.hpp"

#include <bit>
#include <cassert>
#include <cstddef>

namespace yuragi {

void quantise(std::span<const float> angle_rad, std::span<std::int16_t> units) noexcept {
  assert(angle_rad.size() == units.size());
  constexpr float kUnitsPerRad = 32767.0F / 0x1.921fb6p1F;
  constexpr float kLargest = 32767.0F;
  constexpr float kRound = 0x1.8p23F;  // adding it leaves the nearest integer in the low bits

  const std::size_t count = units.size();
  for (std::size_t i = 0; i < count; ++i) {
    const float scaled = angle_rad[i] * kUnitsPerRad;
    const float number = scaled == scaled ? scaled : 0.0F;
    const float above = number < -kLargest ? -kLargest : number;
    const float within = above > kLargest ? kLargest : above;
    units[i] = static_cast<std::int16_t>(std::bit_cast<std::int32_t>(within + kRound));
  }
}

void dequantise(std::span<const std::int16_t> units, std::span<float> angle_rad) noexcept {
  assert(angle_rad.size() == units.size());
  const std::size_t count = units.size();
  for (std::size_t i = 0; i < count; ++i) angle_rad[i] = static_cast<float>(units[i]) * kBendStep_rad;
}

}  // namespace yuragi
