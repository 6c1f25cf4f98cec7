#pragma once

#include <cstddef>
#include <cstdint>

#include "engine/base/kernel.hpp"

// Internal: between quantise.cpp and its kernel.

namespace yuragi::pose {

template <class Unit>
struct QuantiseArguments {
  std::size_t count = 0;
  const float* values = nullptr;
  float units_per_one = 0.0F;
  float smallest = 0.0F;  ///< unit
  float largest = 0.0F;
  Unit* units = nullptr;
};

struct QuantiseKernels {
  void (*to_int16)(const QuantiseArguments<std::int16_t>&) noexcept;
  void (*to_uint8)(const QuantiseArguments<std::uint8_t>&) noexcept;
};

YURAGI_DECLARE_KERNEL_ROWS(QuantiseKernels, quantise_kernels);

}  // namespace yuragi::pose
