#include "engine/pose/tree_kinematics.hpp"

#include <algorithm>

#include "engine/base/kernel.hpp"
#include "engine/pose/strand_kernels.hpp"
#include "engine/pose/tree_kernels.hpp"

namespace yuragi {
namespace {

constexpr KernelRows<StrandKernels> kTreeStrandRows = YURAGI_KERNEL_ROWS(strand_kernels);
constexpr KernelRows<TreeKernels> kTreeRows = YURAGI_KERNEL_ROWS(tree_kernels);

std::size_t strands_per_turn(const TreeLevel& level) noexcept {
  return level.is_turned_by_block ? kStrandsPerBlock : 1;
}

std::size_t turn_count(const TreeLevel& level) noexcept {
  return level.strands.padded_count() / strands_per_turn(level);
}

/// Does every strand of level `index` grow from a link that is there?
bool has_its_parents(const TreeSkeleton& tree, std::size_t index) noexcept {
  const TreeLevel& level = tree.levels[index];
  if (index == 0) return level.parent.empty() && level.parent_link.empty();
  const std::size_t count = level.strands.padded_count();
  if (level.parent_level >= index || level.parent.size() != count || level.parent_link.size() != count) return false;

  // The largest of all, rather than a way out at the first that is too large: so this is vectorised.
  const StrandSkeleton& parents = tree.levels[level.parent_level].strands;
  std::uint32_t parent = 0;
  std::uint32_t link = 0;
  for (std::size_t i = 0; i < count; ++i) {
    parent = std::max(parent, level.parent[i]);
    link = std::max(link, level.parent_link[i]);
  }
  return count == 0 || (parent < parents.padded_count() && link < parents.links_per_strand);
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

TreeJoints::TreeJoints(const TreeSkeleton& tree) {
  levels_.reserve(tree.levels.size());
  stands_.reserve(tree.levels.size());
  for (const TreeLevel& level : tree.levels) {
    levels_.emplace_back(level.strands);
    Stand& stand = stands_.emplace_back();
    const std::size_t turns = padded_to_blocks(turn_count(level));
    stand.turn_w.assign(turns, 1.0F);
    for (auto* zeros : {&stand.turn_x, &stand.turn_y, &stand.turn_z}) zeros->assign(turns, 0.0F);
    if (stands_.size() == 1) continue;
    for (auto* array : {&stand.root_x_m, &stand.root_y_m, &stand.root_z_m, &stand.rest_x, &stand.rest_y, &stand.rest_z,
                        &stand.curl_x, &stand.curl_y, &stand.curl_z}) {
      array->resize(level.strands.padded_count());
    }
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
    if (!has_its_parents(*skeleton, i)) return Problem::kSkeletonSize;
    if (joints->stands_[i].turn_w.size() != padded_to_blocks(turn_count(level))) return Problem::kJointsSize;
  }
  return Problem::kNone;
}

TreeKinematicsJob::Problem TreeKinematicsJob::run() const noexcept {
  const Problem problem = validate();
  if (problem != Problem::kNone) return problem;
  const SimdRow used_row = row.value_or(best_simd_row());

  const auto turns_of = [this](std::size_t level) -> TurnArrays {
    TreeJoints::Stand& stand = joints->stands_[level];
    return {.w = stand.turn_w.data(),
            .x = stand.turn_x.data(),
            .y = stand.turn_y.data(),
            .z = stand.turn_z.data(),
            .strands_per_turn = strands_per_turn(skeleton->levels[level])};
  };

  for (std::size_t i = 0; i < skeleton->levels.size(); ++i) {
    const TreeLevel& level = skeleton->levels[i];
    const StrandSkeleton& strands = level.strands;
    StrandKernelArguments standing{.blocks = strands.padded_count() / kStrandsPerBlock,
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
                                   .curl_sin = joints->levels_[i].curl_sin_.data(),
                                   .curl_versine = joints->levels_[i].curl_versine_.data(),
                                   .link_length_m = strands.link_length_m.data(),
                                   .bend_east_rad = pose->levels[i].bend_east_rad.data(),
                                   .bend_south_rad = pose->levels[i].bend_south_rad.data(),
                                   .joints_m = joints->levels_[i].data().data()};

    // Above the ground, the strands first go with the links that they grow from.
    if (i > 0) {
      const StrandPose& parent_pose = pose->levels[level.parent_level];
      TreeJoints::Stand& stand = joints->stands_[i];
      const TreeKernelArguments carried{
          .blocks = standing.blocks,
          .turns = turn_count(level),
          .parent = level.parent.data(),
          .parent_link = level.parent_link.data(),
          .rest = {standing.rest_x, standing.rest_y, standing.rest_z},
          .curl = {standing.curl_x, standing.curl_y, standing.curl_z},
          .parent_links = skeleton->levels[level.parent_level].strands.links_per_strand,
          .parent_turn = turns_of(level.parent_level),
          .parent_bend_east_rad = parent_pose.bend_east_rad.data(),
          .parent_bend_south_rad = parent_pose.bend_south_rad.data(),
          .parent_joints_m = joints->levels_[level.parent_level].data().data(),
          .turn = turns_of(i),
          .turned_root_m = {stand.root_x_m.data(), stand.root_y_m.data(), stand.root_z_m.data()},
          .turned_rest = {stand.rest_x.data(), stand.rest_y.data(), stand.rest_z.data()},
          .turned_curl = {stand.curl_x.data(), stand.curl_y.data(), stand.curl_z.data()}};
      kTreeRows[used_row].turn(carried);
      kTreeRows[used_row].carry(carried);
      standing.root_x_m = stand.root_x_m.data();
      standing.root_y_m = stand.root_y_m.data();
      standing.root_z_m = stand.root_z_m.data();
      standing.rest_x = stand.rest_x.data();
      standing.rest_y = stand.rest_y.data();
      standing.rest_z = stand.rest_z.data();
      standing.curl_x = stand.curl_x.data();
      standing.curl_y = stand.curl_y.data();
      standing.curl_z = stand.curl_z.data();
    }
    kTreeStrandRows[used_row].joint_positions(standing);
  }
  return Problem::kNone;
}

}  // namespace yuragi
