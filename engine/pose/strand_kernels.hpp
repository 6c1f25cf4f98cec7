#pragma once

#include <cstddef>

#include "engine/base/kernel.hpp"

// Internal: between StrandKinematicsJob, TreeKinematicsJob and their kernel.

namespace yuragi::pose {

/// The arrays of a StrandSkeleton and a StrandPose, in whole blocks, and the output for the joints.
struct StrandKernelArguments {
  std::size_t blocks = 0;
  std::size_t links = 0;
  const float* root_x_m = nullptr;
  const float* root_y_m = nullptr;
  const float* root_z_m = nullptr;
  const float* rest_x = nullptr;
  const float* rest_y = nullptr;
  const float* rest_z = nullptr;
  const float* curl_x = nullptr;
  const float* curl_y = nullptr;
  const float* curl_z = nullptr;
  const float* curl_sin = nullptr;
  const float* curl_versine = nullptr;
  const float* link_length_m = nullptr;
  const float* bend_east_rad = nullptr;
  const float* bend_south_rad = nullptr;
  float* joints_m = nullptr;
};

struct StrandKernels {
  void (*joint_positions)(const StrandKernelArguments&) noexcept;
};

YURAGI_DECLARE_KERNEL_ROWS(StrandKernels, strand_kernels);

}  // namespace yuragi::pose
