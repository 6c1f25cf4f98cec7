#pragma once

#include <bit>
#include <cstdint>
#include <span>
#include <vector>

namespace yuragi {

/// The bits of floats, to be compared where "equal" must mean bit for bit (0 and -0 differ, NaN equals itself).
inline std::vector<std::uint32_t> bits_of(std::span<const float> values) {
  std::vector<std::uint32_t> bits;
  bits.reserve(values.size());
  for (const float value : values) bits.push_back(std::bit_cast<std::uint32_t>(value));
  return bits;
}

}  // namespace yuragi
