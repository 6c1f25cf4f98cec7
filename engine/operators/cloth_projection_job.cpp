#include "engine/operators/cloth_projection_job.hpp"

#include <algorithm>

#include "engine/base/kernel.hpp"
#include "engine/operators/cloth_kernels.hpp"
#include "engine/operators/lean.hpp"

namespace yuragi::operators {
namespace {

constexpr KernelRows<ClothKernels> kClothRows = YURAGI_KERNEL_ROWS(cloth_kernels);

}  // namespace

ClothThreads make_threads(std::size_t links, float link_length_m, std::span<const float> rest_lean) {
  ClothThreads threads{.stride = rest_lean.size() / 2,
                       .links = links,
                       .link_length_m = link_length_m,
                       .rest_lean = {rest_lean.begin(), rest_lean.end()},
                       .rest_end_m = {}};
  const std::size_t stride = threads.stride;
  threads.rest_end_m.resize(3 * stride);
  for (std::size_t i = 0; i < stride; ++i) {
    const LinkEnd<float> rest_m = link_end(rest_lean[i], rest_lean[stride + i], 2.0F * link_length_m);
    threads.rest_end_m[i] = rest_m.east;
    threads.rest_end_m[stride + i] = rest_m.down;
    threads.rest_end_m[2 * stride + i] = rest_m.south;
  }
  return threads;
}

ClothProjectionJob::Problem ClothProjectionJob::validate() const noexcept {
  if (threads == nullptr || pose == nullptr) return Problem::kMissingPart;
  const std::size_t stride = threads->stride;
  if (stride == 0 || stride % pose::kStrandsPerBlock != 0 || threads->rest_lean.size() != 2 * stride ||
      threads->rest_end_m.size() != 3 * stride) {
    return Problem::kThreadsSize;
  }
  if (lean.size() % (2 * stride) != 0 || first_link + lean.size() / (2 * stride) > threads->links) {
    return Problem::kLeanSize;
  }
  if (!edge_m.empty() && edge_m.size() != 3 * stride) return Problem::kEdgeSize;
  for (const auto* array : {&pose->offset_x_m, &pose->offset_y_m, &pose->offset_z_m}) {
    if (array->size() != (threads->links + 1) * stride) return Problem::kPoseSize;
  }
  if (row && !is_runnable(*row)) return Problem::kRowNotRunnable;
  return Problem::kNone;
}

ClothProjectionJob::Problem ClothProjectionJob::run() const noexcept {
  const Problem problem = validate();
  if (problem != Problem::kNone) return problem;
  const std::size_t stride = threads->stride;
  if (first_link == 0) {
    const float* from_m = edge_m.empty() ? nullptr : edge_m.data();
    for (auto* offset_m : {&pose->offset_x_m, &pose->offset_y_m, &pose->offset_z_m}) {
      if (from_m == nullptr) {
        std::fill_n(offset_m->begin(), stride, 0.0F);
      } else {
        std::copy_n(from_m, stride, offset_m->begin());
        from_m += stride;
      }
    }
  }
  const std::size_t from = first_link * stride;
  kClothRows[row.value_or(best_simd_row())].hang({.columns = stride,
                                                  .links = lean.size() / (2 * stride),
                                                  .lean = lean.data(),
                                                  .rest_end_m = threads->rest_end_m.data(),
                                                  .twice_link_length_m = 2.0F * threads->link_length_m,
                                                  .offset_x_m = pose->offset_x_m.data() + from,
                                                  .offset_y_m = pose->offset_y_m.data() + from,
                                                  .offset_z_m = pose->offset_z_m.data() + from});
  return Problem::kNone;
}

}  // namespace yuragi::operators
