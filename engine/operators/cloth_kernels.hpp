#pragma once

#include <cstddef>

// Between the cloth's jobs and their kernels; nobody else needs this.

namespace yuragi {

/// One row of values: out = base + newer_gain * newer + older_gain * older.
struct PropagationKernelArguments {
  std::size_t count = 0;
  const float* base = nullptr;
  const float* newer = nullptr;
  const float* older = nullptr;
  float newer_gain = 0.0F;
  float older_gain = 0.0F;
  float* out = nullptr;
};

/// The links between one row of joints and the next.
struct ClothKernelArguments {
  std::size_t columns = 0;  ///< in whole blocks
  const float* lean = nullptr;
  const float* rest_lean = nullptr;
  const float* rest_direction = nullptr;
  float link_length_m = 0.0F;
  const float* from_x_m = nullptr;
  const float* from_y_m = nullptr;
  const float* from_z_m = nullptr;
  float* to_x_m = nullptr;
  float* to_y_m = nullptr;
  float* to_z_m = nullptr;
};

struct ClothKernels {
  void (*propagate)(const PropagationKernelArguments&) noexcept;
  void (*hang)(const ClothKernelArguments&) noexcept;
};
extern const ClothKernels cloth_kernels_x86_64;
extern const ClothKernels cloth_kernels_x86_64_v3;
extern const ClothKernels cloth_kernels_x86_64_v4;

}  // namespace yuragi
