#pragma once

#include <cstddef>
#include <cstdint>

// As many floats as a register holds of the SIMD row for which a kernel file is compiled (engine/base/kernel.hpp). For
// kernels whose values must stay in registers through a loop; otherwise a plain loop over floats is vectorised just as
// well and reads more easily. Arithmetic is lane by lane, with the same bits as for single floats. A comparison returns
// a mask that ?: takes.
//
// For kernel files only: Lanes is a different type in each row.

namespace yuragi::math {

#if defined(__AVX512F__)
constexpr std::size_t kLaneBytes = 64;
#elif defined(__AVX__)
constexpr std::size_t kLaneBytes = 32;
#else
constexpr std::size_t kLaneBytes = 16;
#endif

using Lanes = float __attribute__((vector_size(kLaneBytes)));
using LaneBits = std::uint32_t __attribute__((vector_size(kLaneBytes)));
constexpr std::size_t kLaneCount = kLaneBytes / sizeof(float);

[[gnu::always_inline]] inline Lanes load_lanes(const float* from) noexcept {
  Lanes lanes;
  __builtin_memcpy(&lanes, from, sizeof lanes);
  return lanes;
}

[[gnu::always_inline]] inline void store_lanes(float* to, Lanes lanes) noexcept {
  __builtin_memcpy(to, &lanes, sizeof lanes);
}

[[gnu::always_inline]] inline Lanes same_lanes(float value) noexcept {
  return value - Lanes{};
}

[[gnu::always_inline]] inline Lanes clamp_lanes(Lanes value, float limit) noexcept {
  const Lanes high = same_lanes(limit);
  const Lanes above = value < -high ? -high : value;
  return above > high ? high : above;
}

[[gnu::always_inline]] inline Lanes sqrt_lanes(Lanes value) noexcept {
  Lanes root;
  for (std::size_t i = 0; i < kLaneCount; ++i) root[i] = __builtin_sqrtf(value[i]);
  return root;
}

}  // namespace yuragi::math
