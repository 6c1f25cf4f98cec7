#pragma once

#include <cstddef>
#include <cstdint>

#include "engine/base/kernel.hpp"

// Internal: between TreeKinematicsJob and its kernels.

namespace yuragi::pose {

/// Unit quaternions as four arrays. Strand s has turn s / strands_per_turn.
struct TurnArrays {
  float* w = nullptr;
  float* x = nullptr;
  float* y = nullptr;
  float* z = nullptr;
  std::size_t strands_per_turn = 1;  ///< 1, or 16: a turn for each block
};

/// The strands of one level at rest, the level from which they grow, and the present state of some of them.
struct TreeKernelArguments {
  std::size_t turns = 0;
  const std::uint32_t* parent = nullptr;
  const std::uint32_t* parent_link = nullptr;
  const float* rest[3] = {};
  const float* curl[3] = {};

  std::size_t parent_links = 0;
  TurnArrays parent_turn;
  const float* parent_bend_east_rad = nullptr;
  const float* parent_bend_south_rad = nullptr;
  const float* parent_joints_m = nullptr;

  TurnArrays turn;  ///< output for `turns`, in whole blocks

  std::size_t first_block = 0;  ///< of the carried strands
  std::size_t blocks = 0;
  float* carried_root_m[3] = {};  ///< beginning with the first strand of that block
  float* carried_rest[3] = {};
  float* carried_curl[3] = {};
};

struct TreeKernels {
  /// Returns true if all of these numbers are below `limit`, which is at most 2^31.
  bool (*all_below)(const std::uint32_t* numbers, std::size_t count, std::uint32_t limit) noexcept;
  /// Parent's turn and bend -> `turn`, for all strands.
  void (*turn)(const TreeKernelArguments&) noexcept;
  /// Computes the `carried_` arrays from `turn`, rest, curl and the parent's joints, for some blocks.
  void (*carry)(const TreeKernelArguments&) noexcept;
};

YURAGI_DECLARE_KERNEL_ROWS(TreeKernels, tree_kernels);

}  // namespace yuragi::pose
