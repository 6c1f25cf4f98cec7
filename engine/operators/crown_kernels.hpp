#pragma once

#include <cstddef>
#include <cstdint>

#include "engine/base/kernel.hpp"

// Internal: between the jobs that move a tree's crown (SplitJob, BranchForceJob, TiltJob, LeafResponseJob, FlutterJob)
// and their kernels.

namespace yuragi::operators {

struct SplitKernelArguments {
  std::size_t count = 0;
  const float* noise = nullptr;
  const float* ramp = nullptr;
  float threshold = 0.0F;
  float threshold_rise = 0.0F;
  float width = 1.0F;
  float* above = nullptr;
  float* below = nullptr;
};

struct ForceKernelArguments {
  std::size_t count = 0;
  const float* wind_east_m_s = nullptr;
  const float* wind_south_m_s = nullptr;
  float per_streamline_speed = 0.0F;
  float per_mean_force = 0.0F;
  float calm_square = 0.0F;
  float* noise = nullptr;
  float* toward_east = nullptr;
  float* toward_south = nullptr;
};

struct TiltKernelArguments {
  std::size_t count = 0;
  float force = 0.0F;
  const float* toward_east = nullptr;
  const float* toward_south = nullptr;
  const float* vertical = nullptr;
  const float* horizontal = nullptr;
  const float* distance = nullptr;
  const float* gain = nullptr;
  float alpha_vertical = 0.0F;
  float beta_horizontal = 0.0F;
  float max_tilt_rad = 0.0F;
  float max_swing_rad = 0.0F;
  float* out_east_rad = nullptr;
  float* out_south_rad = nullptr;
};

struct LeafKernelArguments {
  std::size_t count = 0;
  const float* wind_east_m_s = nullptr;
  const float* wind_south_m_s = nullptr;
  float per_half_lean_speed = 0.0F;
  float eighth_per_flutter_square = 0.0F;
  float lean_rad = 0.0F;
  float flutter_rad = 0.0F;
  float* out_lean_east_rad = nullptr;
  float* out_lean_south_rad = nullptr;
  float* out_flutter_rad = nullptr;
};

struct FlutterKernelArguments {
  std::size_t sprays = 0;
  const std::uint32_t* place = nullptr;
  const float* lean_east_rad = nullptr;
  const float* lean_south_rad = nullptr;
  const float* flutter_rad = nullptr;
  const float* noise = nullptr;
  const float* give = nullptr;
  const float* axis_east = nullptr;
  const float* axis_south = nullptr;
  float* out_east_rad = nullptr;
  float* out_south_rad = nullptr;
};

struct CrownKernels {
  void (*split)(const SplitKernelArguments&) noexcept;
  void (*force)(const ForceKernelArguments&) noexcept;
  void (*tilt)(const TiltKernelArguments&) noexcept;
  void (*respond)(const LeafKernelArguments&) noexcept;
  void (*flutter)(const FlutterKernelArguments&) noexcept;
};
YURAGI_DECLARE_KERNEL_ROWS(CrownKernels, crown_kernels);

}  // namespace yuragi::operators
