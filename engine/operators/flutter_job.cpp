#include "engine/operators/flutter_job.hpp"

#include <algorithm>

#include "engine/base/kernel.hpp"
#include "engine/operators/crown_kernels.hpp"

namespace yuragi::operators {
namespace {

constexpr KernelRows<CrownKernels> kFlutterRows = YURAGI_KERNEL_ROWS(crown_kernels);

}  // namespace

FlutterJob::Problem FlutterJob::validate() const noexcept {
  const std::size_t places = flutter_rad.size();
  if (lean_east_rad.size() != places || lean_south_rad.size() != places) return Problem::kSizesDiffer;
  const std::size_t count = noise.size();
  if (count != kLeavesOfASpray * place.size()) return Problem::kSizesDiffer;
  for (const std::size_t size :
       {give.size(), axis_east.size(), axis_south.size(), bend_east_rad.size(), bend_south_rad.size()}) {
    if (size != count) return Problem::kSizesDiffer;
  }
  if (std::any_of(place.begin(), place.end(), [places](std::uint32_t one) { return one >= places; })) {
    return Problem::kPlace;
  }
  if (row && !is_runnable(*row)) return Problem::kRowNotRunnable;
  return Problem::kNone;
}

FlutterJob::Problem FlutterJob::run() const noexcept {
  const Problem problem = validate();
  if (problem != Problem::kNone) return problem;
  kFlutterRows[row.value_or(best_simd_row())].flutter({.sprays = place.size(),
                                                       .place = place.data(),
                                                       .lean_east_rad = lean_east_rad.data(),
                                                       .lean_south_rad = lean_south_rad.data(),
                                                       .flutter_rad = flutter_rad.data(),
                                                       .noise = noise.data(),
                                                       .give = give.data(),
                                                       .axis_east = axis_east.data(),
                                                       .axis_south = axis_south.data(),
                                                       .out_east_rad = bend_east_rad.data(),
                                                       .out_south_rad = bend_south_rad.data()});
  return Problem::kNone;
}

}  // namespace yuragi::operators
