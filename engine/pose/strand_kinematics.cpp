#include "engine/pose/strand_kinematics.hpp"

#include "engine/base/kernel.hpp"
#include "engine/pose/strand_kernels.hpp"

namespace yuragi {
namespace {

constexpr KernelRows<StrandKernels> kStrandRows = YURAGI_KERNEL_ROWS(strand_kernels);

bool has_its_sizes(const StrandSkeleton& skeleton) noexcept {
  const std::size_t count = skeleton.padded_count();
  for (const auto* array : {&skeleton.root_x_m, &skeleton.root_y_m, &skeleton.root_z_m, &skeleton.rest_x,
                            &skeleton.rest_y, &skeleton.rest_z, &skeleton.curl_x, &skeleton.curl_y, &skeleton.curl_z,
                            &skeleton.rest_curl_rad, &skeleton.link_length_m}) {
    if (array->size() != count) return false;
  }
  return skeleton.links_per_strand > 0;
}

}  // namespace

StrandKinematicsJob::Problem StrandKinematicsJob::validate() const noexcept {
  if (skeleton == nullptr || pose == nullptr || joints == nullptr) return Problem::kMissingPart;
  if (!has_its_sizes(*skeleton)) return Problem::kSkeletonSize;

  const std::size_t count = skeleton->padded_count();
  if (pose->bend_east_rad.size() != count || pose->bend_south_rad.size() != count) return Problem::kPoseSize;
  const std::size_t links = skeleton->links_per_strand;
  if (joints->links_per_strand() != links || joints->data().size() != count * links * 3) return Problem::kJointsSize;

  if (row && !is_runnable(*row)) return Problem::kRowNotRunnable;
  return Problem::kNone;
}

StrandKinematicsJob::Problem StrandKinematicsJob::run() const noexcept {
  const Problem problem = validate();
  if (problem != Problem::kNone) return problem;

  const StrandKernels& kernels = kStrandRows[row.value_or(best_simd_row())];
  kernels.joint_positions({.blocks = skeleton->padded_count() / kStrandsPerBlock,
                           .links = skeleton->links_per_strand,
                           .root_x_m = skeleton->root_x_m.data(),
                           .root_y_m = skeleton->root_y_m.data(),
                           .root_z_m = skeleton->root_z_m.data(),
                           .rest_x = skeleton->rest_x.data(),
                           .rest_y = skeleton->rest_y.data(),
                           .rest_z = skeleton->rest_z.data(),
                           .curl_x = skeleton->curl_x.data(),
                           .curl_y = skeleton->curl_y.data(),
                           .curl_z = skeleton->curl_z.data(),
                           .rest_curl_rad = skeleton->rest_curl_rad.data(),
                           .link_length_m = skeleton->link_length_m.data(),
                           .bend_east_rad = pose->bend_east_rad.data(),
                           .bend_south_rad = pose->bend_south_rad.data(),
                           .joints_m = joints->data().data()});
  return Problem::kNone;
}

}  // namespace yuragi
