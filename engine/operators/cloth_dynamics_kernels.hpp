#pragma once

#include <cstddef>

#include "engine/base/kernel.hpp"

// Internal: between the cloth's dynamics and their kernel.

namespace yuragi::operators {

struct ClothDynamicsKernelArguments {
  std::size_t stride = 0;
  std::size_t rows = 0;
  std::size_t columns = 0;  ///< without ghosts
  std::size_t substeps = 0;
  float substep_s = 0.0F;
  float weight_s2 = 0.0F;  ///< of one link below, per link
  float across_s2 = 0.0F;
  float normal_drag = 0.0F;  ///< per metre times the substep
  float speed_kept = 1.0F;
  float largest_speed_m_s = 0.0F;
  float largest_lean_step = 0.0F;
  const float* rest_link_m = nullptr;
  const float* rest_length_m = nullptr;  ///< in the kernel's order of summation
  const float* skin_share = nullptr;     ///< of the relative speed, in a substep
  const float* across_m = nullptr;
  const float* across_growth_m = nullptr;
  const float* mobility = nullptr;
  const float* air_east_m_s = nullptr;
  const float* air_south_m_s = nullptr;
  float* offset_m = nullptr;  ///< readable one block beyond its end
  float* predicted_m = nullptr;
  float* speed_m_s = nullptr;
  float* lean = nullptr;
};

/// One row of columns from coarse to fine: `taps` coarse columns for each block of 16.
struct ClothSpreadKernelArguments {
  std::size_t blocks = 0;
  std::size_t taps = 0;
  const std::size_t* first = nullptr;  ///< coarse column of each block's first tap
  const float* weights = nullptr;      ///< [block][tap][16]
  const float* coarse = nullptr;
  float* fine = nullptr;
};

/// out += sum of weight[i] * row[i]
struct ClothAddKernelArguments {
  std::size_t count = 0;
  const float* row[4] = {};
  float weight[4] = {};
  float* out = nullptr;
};

struct ClothDynamicsKernels {
  void (*step)(const ClothDynamicsKernelArguments&) noexcept;
  void (*spread)(const ClothSpreadKernelArguments&) noexcept;
  void (*add)(const ClothAddKernelArguments&) noexcept;
};
YURAGI_DECLARE_KERNEL_ROWS(ClothDynamicsKernels, cloth_dynamics_kernels);

}  // namespace yuragi::operators
