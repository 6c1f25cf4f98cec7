#include "engine/operators/leaf_response_job.hpp"

#include <cmath>

#include "engine/base/kernel.hpp"
#include "engine/operators/crown_kernels.hpp"

namespace yuragi::operators {
namespace {

constexpr KernelRows<CrownKernels> kLeafRows = YURAGI_KERNEL_ROWS(crown_kernels);

}  // namespace

LeafResponseJob::Problem LeafResponseJob::validate() const noexcept {
  for (const double speed_m_s : {half_lean_speed_m_s, flutter_speed_m_s}) {
    if (!(speed_m_s >= 0.01 && speed_m_s <= 1e6)) return Problem::kSpeeds;
  }
  if (!std::isfinite(lean_rad) || !std::isfinite(flutter_rad)) return Problem::kAngles;
  const std::size_t count = wind_east_m_s.size();
  for (const std::size_t size :
       {wind_south_m_s.size(), lean_east_rad.size(), lean_south_rad.size(), flutter_rad_each.size()}) {
    if (size != count) return Problem::kSizesDiffer;
  }
  if (row && !is_runnable(*row)) return Problem::kRowNotRunnable;
  return Problem::kNone;
}

LeafResponseJob::Problem LeafResponseJob::run() const noexcept {
  const Problem problem = validate();
  if (problem != Problem::kNone) return problem;
  const double per_flutter_speed = 1.0 / flutter_speed_m_s;
  kLeafRows[row.value_or(best_simd_row())].respond(
      {.count = wind_east_m_s.size(),
       .wind_east_m_s = wind_east_m_s.data(),
       .wind_south_m_s = wind_south_m_s.data(),
       .per_half_lean_speed = static_cast<float>(1.0 / half_lean_speed_m_s),
       .eighth_per_flutter_square = static_cast<float>(0.125 * per_flutter_speed * per_flutter_speed),
       .lean_rad = static_cast<float>(lean_rad),
       .flutter_rad = static_cast<float>(flutter_rad),
       .out_lean_east_rad = lean_east_rad.data(),
       .out_lean_south_rad = lean_south_rad.data(),
       .out_flutter_rad = flutter_rad_each.data()});
  return Problem::kNone;
}

}  // namespace yuragi::operators
