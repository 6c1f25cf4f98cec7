#pragma once

#include <cstddef>
#include <cstdint>

// Between the jobs of this folder and their kernels; nobody else needs this.

namespace yuragi {

struct SampleKernelArguments {
  std::size_t count = 0;
  const float* tile = nullptr;
  unsigned log2_size = 0;
  const std::uint32_t* place_x = nullptr;
  const std::uint32_t* place_z = nullptr;
  std::uint32_t offset_x = 0;
  std::uint32_t offset_z = 0;
  float scale = 0.0F;
  float bias = 0.0F;
  float low = 0.0F;
  float high = 0.0F;
  float* out = nullptr;
};

struct BendingKernelArguments {
  std::size_t count = 0;
  const float* strength = nullptr;
  const float* flexibility = nullptr;
  float wind_in_half_bends = 0.0F;  ///< wind speed / half-bend speed
  float bend_east_rad = 0.0F;       ///< the largest bend, toward where the wind blows
  float bend_south_rad = 0.0F;
  float* out_east_rad = nullptr;
  float* out_south_rad = nullptr;
};

struct SampleKernels {
  void (*sample)(const SampleKernelArguments&) noexcept;
};
extern const SampleKernels sample_kernels_x86_64;
extern const SampleKernels sample_kernels_x86_64_v3;
extern const SampleKernels sample_kernels_x86_64_v4;

struct BendingKernels {
  void (*bend)(const BendingKernelArguments&) noexcept;
};
extern const BendingKernels bending_kernels_x86_64;
extern const BendingKernels bending_kernels_x86_64_v3;
extern const BendingKernels bending_kernels_x86_64_v4;

}  // namespace yuragi
