#pragma once

#include <cstddef>

#include "engine/base/kernel.hpp"

// Internal: between the cloth's jobs and their kernels.

namespace yuragi::operators {

/// One row of values, from a newer and an older one: out = base + newer_gain * newer + older_gain * older.
struct PropagationKernelArguments {
  std::size_t count = 0;
  const float* base = nullptr;
  const float* newer = nullptr;
  const float* older = nullptr;
  float newer_gain = 0.0F;
  float older_gain = 0.0F;
  float* out = nullptr;
};

/// A band of links, from a row of joints with known offsets to those below it.
struct ClothKernelArguments {
  std::size_t columns = 0;  ///< in whole blocks
  std::size_t links = 0;
  const float* lean = nullptr;
  const float* rest_end_m = nullptr;
  float twice_link_length_m = 0.0F;
  float* offset_x_m = nullptr;  ///< of the row at which the band begins
  float* offset_y_m = nullptr;
  float* offset_z_m = nullptr;
};

struct ClothKernels {
  void (*propagate)(const PropagationKernelArguments&) noexcept;
  void (*hang)(const ClothKernelArguments&) noexcept;
};
YURAGI_DECLARE_KERNEL_ROWS(ClothKernels, cloth_kernels);

}  // namespace yuragi::operators
