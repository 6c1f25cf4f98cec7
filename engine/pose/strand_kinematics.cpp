#include "engine/pose/strand_kinematics.hpp"

#include <algorithm>
#include <cmath>

#include "engine/base/kernel.hpp"
#include "engine/pose/strand_kernels.hpp"

namespace yuragi::pose {
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

/// Limit for curls.
constexpr float kMaxCurl_rad = 32.0F;

}  // namespace

JointPositions::JointPositions(const StrandSkeleton& skeleton)
    : links_(skeleton.links_per_strand), data_(skeleton.padded_count() * links_ * 3) {
  // In double, so that the versine of a small curl is as exact as a float can be.
  for (const float curl_rad : skeleton.rest_curl_rad) {
    const auto curl = static_cast<double>(std::clamp(curl_rad, -kMaxCurl_rad, kMaxCurl_rad));
    const double half_sin = std::sin(0.5 * curl);
    curl_sin_.push_back(static_cast<float>(std::sin(curl)));
    curl_versine_.push_back(static_cast<float>(2.0 * half_sin * half_sin));
  }
}

StrandKinematicsJob::Problem StrandKinematicsJob::validate() const noexcept {
  if (skeleton == nullptr || pose == nullptr || joints == nullptr) return Problem::kMissingPart;
  if (!has_its_sizes(*skeleton)) return Problem::kSkeletonSize;

  const std::size_t count = skeleton->padded_count();
  if (pose->bend_east_rad.size() != count || pose->bend_south_rad.size() != count) return Problem::kPoseSize;
  const std::size_t links = skeleton->links_per_strand;
  if (joints->links_per_strand() != links || joints->data().size() != count * links * 3 ||
      joints->curl_sin_.size() != count) {
    return Problem::kJointsSize;
  }

  if (row && !is_runnable(*row)) return Problem::kRowNotRunnable;
  return Problem::kNone;
}

StrandKinematicsJob::Problem StrandKinematicsJob::run() const noexcept {
  const Problem problem = validate();
  if (problem != Problem::kNone) return problem;

  const StrandKernels& kernels = kStrandRows[row.value_or(best_simd_row())];
  const std::size_t blocks = skeleton->padded_count() / kStrandsPerBlock;
  const std::size_t first = part.begin(blocks) * kStrandsPerBlock;
  kernels.joint_positions({.blocks = part.end(blocks) - part.begin(blocks),
                           .links = skeleton->links_per_strand,
                           .root_x_m = skeleton->root_x_m.data() + first,
                           .root_y_m = skeleton->root_y_m.data() + first,
                           .root_z_m = skeleton->root_z_m.data() + first,
                           .rest_x = skeleton->rest_x.data() + first,
                           .rest_y = skeleton->rest_y.data() + first,
                           .rest_z = skeleton->rest_z.data() + first,
                           .curl_x = skeleton->curl_x.data() + first,
                           .curl_y = skeleton->curl_y.data() + first,
                           .curl_z = skeleton->curl_z.data() + first,
                           .curl_sin = joints->curl_sin_.data() + first,
                           .curl_versine = joints->curl_versine_.data() + first,
                           .link_length_m = skeleton->link_length_m.data() + first,
                           .bend_east_rad = pose->bend_east_rad.data() + first,
                           .bend_south_rad = pose->bend_south_rad.data() + first,
                           .joints_m = joints->data().data() + first * skeleton->links_per_strand * 3});
  return Problem::kNone;
}

}  // namespace yuragi::pose
