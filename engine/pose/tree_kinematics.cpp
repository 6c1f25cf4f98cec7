#include "engine/pose/tree_kinematics.hpp"

#include <algorithm>
#include <limits>

#include "engine/base/kernel.hpp"
#include "engine/pose/strand_kernels.hpp"
#include "engine/pose/tree_kernels.hpp"

namespace yuragi::pose {
namespace {

constexpr KernelRows<StrandKernels> kTreeStrandRows = YURAGI_KERNEL_ROWS(strand_kernels);
constexpr KernelRows<TreeKernels> kTreeRows = YURAGI_KERNEL_ROWS(tree_kernels);

/// So many blocks are processed at a time that they stay in the fastest cache until their joints are computed.
constexpr std::size_t kBlocksAtOnce = 8;
/// The places of a level's numbers are computed in 32 bits.
constexpr std::size_t kMaxNumbers = std::numeric_limits<std::uint32_t>::max();

constexpr std::size_t kStrandsAtOnce = kBlocksAtOnce * kStrandsPerBlock;

std::size_t strands_per_turn(const TreeLevel& level) noexcept {
  return level.is_turned_by_block ? kStrandsPerBlock : 1;
}

std::size_t turn_count(const TreeLevel& level) noexcept {
  return level.strands.padded_count() / strands_per_turn(level);
}

/// Returns true if every strand of level `index` grows from an existing link.
bool has_its_parents(const TreeSkeleton& tree, std::size_t index, const TreeKernels& kernels) noexcept {
  const TreeLevel& level = tree.levels[index];
  if (index == 0) return level.parent.empty() && level.parent_link.empty();
  const std::size_t count = level.strands.padded_count();
  if (level.parent_level >= index || level.parent.size() != count || level.parent_link.size() != count) return false;
  const StrandSkeleton& parents = tree.levels[level.parent_level].strands;
  if (parents.padded_count() > kMaxNumbers / 3 / parents.links_per_strand) return false;
  const auto all_below = [&](const std::vector<std::uint32_t>& numbers, std::size_t limit) {
    return kernels.all_below(numbers.data(), count, static_cast<std::uint32_t>(limit));
  };
  return all_below(level.parent, parents.padded_count()) && all_below(level.parent_link, parents.links_per_strand);
}

/// The same problem in the tree's terms.
TreeKinematicsJob::Problem of_tree(StrandKinematicsJob::Problem problem) noexcept {
  using Of = StrandKinematicsJob::Problem;
  using To = TreeKinematicsJob::Problem;
  switch (problem) {
    case Of::kNone:
      return To::kNone;
    case Of::kMissingPart:
      return To::kMissingPart;
    case Of::kSkeletonSize:
      return To::kSkeletonSize;
    case Of::kPoseSize:
      return To::kPoseSize;
    case Of::kJointsSize:
      return To::kJointsSize;
    case Of::kRowNotRunnable:
      break;
  }
  return To::kRowNotRunnable;
}

}  // namespace

TreeJoints::TreeJoints(const TreeSkeleton& tree) : standing_(9 * kStrandsAtOnce) {
  levels_.reserve(tree.levels.size());
  for (const TreeLevel& level : tree.levels) {
    levels_.emplace_back(level.strands);
    const std::size_t turns = padded_to_blocks(turn_count(level));
    const std::vector<float> zeros(turns, 0.0F);
    turns_.push_back({std::vector<float>(turns, 1.0F), zeros, zeros, zeros});
  }
}

TreeKinematicsJob::Problem TreeKinematicsJob::validate() const noexcept {
  if (skeleton == nullptr || pose == nullptr || joints == nullptr) return Problem::kMissingPart;
  const std::size_t levels = skeleton->levels.size();
  if (levels == 0 || levels > kMaxTreeLevels) return Problem::kSkeletonSize;
  if (pose->levels.size() != levels) return Problem::kPoseSize;
  if (joints->level_count() != levels) return Problem::kJointsSize;

  for (std::size_t i = 0; i < levels; ++i) {
    const TreeLevel& level = skeleton->levels[i];
    const StrandKinematicsJob strands{
        .skeleton = &level.strands, .pose = &pose->levels[i], .row = row, .joints = &joints->levels_[i]};
    const Problem problem = of_tree(strands.validate());
    if (problem != Problem::kNone) return problem;
    if (!has_its_parents(*skeleton, i, kTreeRows[row.value_or(best_simd_row())])) return Problem::kSkeletonSize;
    if (joints->turns_[i].w.size() != padded_to_blocks(turn_count(level))) return Problem::kJointsSize;
  }
  return Problem::kNone;
}

TreeKinematicsJob::Problem TreeKinematicsJob::run() const noexcept {
  const Problem problem = validate();
  if (problem != Problem::kNone) return problem;
  const TreeKernels& tree_kernels = kTreeRows[row.value_or(best_simd_row())];
  const StrandKernels& strand_kernels = kTreeStrandRows[row.value_or(best_simd_row())];

  for (std::size_t i = 0; i < skeleton->levels.size(); ++i) {
    StrandKernelArguments strands = strands_of(i);
    if (i == 0) {
      strand_kernels.joint_positions(strands);
      continue;
    }

    // Above the ground, strands first go with the links that they grow from.
    TreeKernelArguments carried = carried_from_parents(i);
    tree_kernels.turn(carried);
    strands.root_x_m = carried.carried_root_m[0];
    strands.root_y_m = carried.carried_root_m[1];
    strands.root_z_m = carried.carried_root_m[2];
    strands.rest_x = carried.carried_rest[0];
    strands.rest_y = carried.carried_rest[1];
    strands.rest_z = carried.carried_rest[2];
    strands.curl_x = carried.carried_curl[0];
    strands.curl_y = carried.carried_curl[1];
    strands.curl_z = carried.carried_curl[2];
    const std::size_t all_blocks = strands.blocks;
    for (std::size_t block = 0; block < all_blocks; block += kBlocksAtOnce) {
      carried.first_block = block;
      carried.blocks = strands.blocks = std::min(kBlocksAtOnce, all_blocks - block);
      tree_kernels.carry(carried);
      strand_kernels.joint_positions(strands);
      strands.curl_sin += kStrandsAtOnce;
      strands.curl_versine += kStrandsAtOnce;
      strands.link_length_m += kStrandsAtOnce;
      strands.bend_east_rad += kStrandsAtOnce;
      strands.bend_south_rad += kStrandsAtOnce;
      strands.joints_m += kStrandsAtOnce * strands.links * 3;
    }
  }
  return Problem::kNone;
}

StrandKernelArguments TreeKinematicsJob::strands_of(std::size_t level) const noexcept {
  const StrandSkeleton& strands = skeleton->levels[level].strands;
  return {.blocks = strands.padded_count() / kStrandsPerBlock,
          .links = strands.links_per_strand,
          .root_x_m = strands.root_x_m.data(),
          .root_y_m = strands.root_y_m.data(),
          .root_z_m = strands.root_z_m.data(),
          .rest_x = strands.rest_x.data(),
          .rest_y = strands.rest_y.data(),
          .rest_z = strands.rest_z.data(),
          .curl_x = strands.curl_x.data(),
          .curl_y = strands.curl_y.data(),
          .curl_z = strands.curl_z.data(),
          .curl_sin = joints->levels_[level].curl_sin_.data(),
          .curl_versine = joints->levels_[level].curl_versine_.data(),
          .link_length_m = strands.link_length_m.data(),
          .bend_east_rad = pose->levels[level].bend_east_rad.data(),
          .bend_south_rad = pose->levels[level].bend_south_rad.data(),
          .joints_m = joints->levels_[level].data().data()};
}

TurnArrays TreeKinematicsJob::turns_of(std::size_t level) const noexcept {
  TreeJoints::Turns& turns = joints->turns_[level];
  return {.w = turns.w.data(),
          .x = turns.x.data(),
          .y = turns.y.data(),
          .z = turns.z.data(),
          .strands_per_turn = strands_per_turn(skeleton->levels[level])};
}

TreeKernelArguments TreeKinematicsJob::carried_from_parents(std::size_t index) const noexcept {
  const TreeLevel& level = skeleton->levels[index];
  const StrandSkeleton& strands = level.strands;
  const StrandPose& parent_pose = pose->levels[level.parent_level];
  float* const standing = joints->standing_.data();
  const auto array = [standing](std::size_t which) { return standing + which * kStrandsAtOnce; };
  return {.turns = turn_count(level),
          .parent = level.parent.data(),
          .parent_link = level.parent_link.data(),
          .rest = {strands.rest_x.data(), strands.rest_y.data(), strands.rest_z.data()},
          .curl = {strands.curl_x.data(), strands.curl_y.data(), strands.curl_z.data()},
          .parent_links = skeleton->levels[level.parent_level].strands.links_per_strand,
          .parent_turn = turns_of(level.parent_level),
          .parent_bend_east_rad = parent_pose.bend_east_rad.data(),
          .parent_bend_south_rad = parent_pose.bend_south_rad.data(),
          .parent_joints_m = joints->levels_[level.parent_level].data().data(),
          .turn = turns_of(index),
          .carried_root_m = {array(0), array(1), array(2)},
          .carried_rest = {array(3), array(4), array(5)},
          .carried_curl = {array(6), array(7), array(8)}};
}

}  // namespace yuragi::pose
