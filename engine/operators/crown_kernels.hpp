#pragma once

#include <cstddef>

// Between the jobs that move a tree's crown (SplitJob, TiltJob, FlutterJob) and their kernels; nobody else needs this.

namespace yuragi {

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

struct TiltKernelArguments {
  std::size_t count = 0;
  const float* vertical = nullptr;
  const float* horizontal = nullptr;
  const float* distance = nullptr;
  const float* gain = nullptr;
  float response = 0.0F;     ///< to the wind, 0 to 1
  float toward_east = 0.0F;  ///< where the wind blows to: a unit vector, or (0, 0)
  float toward_south = 0.0F;
  float alpha_vertical = 0.0F;
  float beta_horizontal = 0.0F;
  float max_tilt_rad = 0.0F;
  float max_swing_rad = 0.0F;
  float* out_east_rad = nullptr;
  float* out_south_rad = nullptr;
};

struct FlutterKernelArguments {
  std::size_t count = 0;
  const float* noise = nullptr;
  const float* along = nullptr;
  const float* across = nullptr;
  float lean_rad = 0.0F;
  float flutter_rad = 0.0F;
  float toward_east = 0.0F;  ///< where the wind blows to, as long as the response to it
  float toward_south = 0.0F;
  float* out_east_rad = nullptr;
  float* out_south_rad = nullptr;
};

struct CrownKernels {
  void (*split)(const SplitKernelArguments&) noexcept;
  void (*tilt)(const TiltKernelArguments&) noexcept;
  void (*flutter)(const FlutterKernelArguments&) noexcept;
};
extern const CrownKernels crown_kernels_x86_64;
extern const CrownKernels crown_kernels_x86_64_v3;
extern const CrownKernels crown_kernels_x86_64_v4;

}  // namespace yuragi
