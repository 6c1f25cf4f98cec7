#include "engine/pose/quantise_kernels.hpp"

#include "engine/base/kernel.hpp"

namespace yuragi::pose {
namespace {

/// values * units_per_one, from `smallest` to `largest`, rounded to the nearest; NaN becomes 0.
template <class Unit>
[[gnu::always_inline]] inline void quantise_all(const QuantiseArguments<Unit>& arguments) noexcept {
  constexpr float kRound = 0x1.8p23F;  // adding it leaves the nearest integer in the low bits

  const QuantiseArguments<Unit> in = arguments;  // a copy, which stores to `units` cannot change
  const float* __restrict const values = in.values;
  Unit* __restrict const units = in.units;
  for (std::size_t i = 0; i < in.count; ++i) {
    const float scaled = values[i] * in.units_per_one;
    const float number = scaled == scaled ? scaled : 0.0F;
    const float above = number < in.smallest ? in.smallest : number;
    const float within = above > in.largest ? in.largest : above;
    units[i] = static_cast<Unit>(__builtin_bit_cast(std::int32_t, within + kRound));
  }
}

void to_int16(const QuantiseArguments<std::int16_t>& in) noexcept {
  quantise_all(in);
}

void to_uint8(const QuantiseArguments<std::uint8_t>& in) noexcept {
  quantise_all(in);
}

}  // namespace

const QuantiseKernels YURAGI_ROW_NAME(quantise_kernels) = {to_int16, to_uint8};

}  // namespace yuragi::pose
