#pragma once

#include <cstddef>

#include "engine/base/kernel.hpp"

// Internal: between ThresholdRampJob, DisplacementJob and their kernels.

namespace yuragi::operators {

struct ThresholdRampArguments {
  std::size_t count = 0;
  const float* noise = nullptr;
  const float* along = nullptr;
  float first_threshold = 0.0F;
  float rise = 0.0F;  ///< from the first threshold to the last
  float per_edge = 1.0F;
  float* out = nullptr;
};

struct DisplacementArguments {
  std::size_t count = 0;
  const float* noise = nullptr;
  const float* share = nullptr;
  float amplitude_m = 0.0F;
  float* out = nullptr;
};

struct SurfaceKernels {
  void (*threshold_ramp)(const ThresholdRampArguments&) noexcept;
  void (*displace)(const DisplacementArguments&) noexcept;
};
YURAGI_DECLARE_KERNEL_ROWS(SurfaceKernels, surface_kernels);

}  // namespace yuragi::operators
