#pragma once

#include <cstddef>
#include <cstdint>

#include "engine/base/kernel.hpp"

// Internal: between GridSampleJob and its kernel.

namespace yuragi::operators {

struct GridSampleKernelLayer {
  const float* tile = nullptr;
  unsigned log2_size = 0;
  const std::uint32_t* column_x = nullptr;
  const std::uint32_t* row_z = nullptr;
  std::uint32_t offset_x = 0;
  std::uint32_t offset_z = 0;
  float weight = 1.0F;
};

struct GridSampleKernelArguments {
  std::size_t columns = 0;
  std::size_t rows = 0;
  std::size_t layer_count = 0;
  GridSampleKernelLayer layers[4] = {};
  float* out = nullptr;
};

struct GridSampleKernels {
  void (*sample)(const GridSampleKernelArguments&) noexcept;
};
YURAGI_DECLARE_KERNEL_ROWS(GridSampleKernels, grid_sample_kernels);

}  // namespace yuragi::operators
