#pragma once

#include <cstddef>
#include <cstdint>

#include "engine/base/kernel.hpp"

// Internal: between EvolvingNoise and its kernels.

namespace yuragi::noise {

struct TurnModesArguments {
  std::size_t count = 0;
  const double* first_re = nullptr;
  const double* first_im = nullptr;
  const double* turns_per_s = nullptr;
  double dt_s = 0.0;
  std::uint32_t* phase = nullptr;
  double* out_modes = nullptr;  ///< count times real part, imaginary part
};

struct StandardiseArguments {
  std::size_t count = 0;
  const double* samples = nullptr;
  double mean = 0.0;
  double scale = 1.0;
  float* out = nullptr;
};

struct NoiseKernels {
  void (*turn_modes)(const TurnModesArguments&) noexcept;
  void (*standardise)(const StandardiseArguments&) noexcept;
};
YURAGI_DECLARE_KERNEL_ROWS(NoiseKernels, noise_kernels);

}  // namespace yuragi::noise
