#include "engine/operators/flutter_job.hpp"

#include <cmath>

#include "engine/base/kernel.hpp"
#include "engine/operators/crown_kernels.hpp"
#include "engine/operators/wind_response.hpp"

namespace yuragi {
namespace {

constexpr KernelRows<CrownKernels> kFlutterRows = YURAGI_KERNEL_ROWS(crown_kernels);

}  // namespace

FlutterJob::Problem FlutterJob::validate() const noexcept {
  if (!std::isfinite(wind_east_m_s * wind_east_m_s + wind_south_m_s * wind_south_m_s)) return Problem::kWindNotFinite;
  if (!std::isfinite(half_flutter_speed_m_s) || half_flutter_speed_m_s < kSlowestResponseSpeed_m_s) {
    return Problem::kHalfFlutterSpeed;
  }
  if (!std::isfinite(lean_rad) || !std::isfinite(flutter_rad)) return Problem::kAngles;
  const std::size_t count = noise.size();
  for (const std::size_t size : {along.size(), across.size(), bend_east_rad.size(), bend_south_rad.size()}) {
    if (size != count) return Problem::kSizesDiffer;
  }
  if (row && !is_runnable(*row)) return Problem::kRowNotRunnable;
  return Problem::kNone;
}

FlutterJob::Problem FlutterJob::run() const noexcept {
  const Problem problem = validate();
  if (problem != Problem::kNone) return problem;
  const auto response = WindResponse::to(wind_east_m_s, wind_south_m_s, half_flutter_speed_m_s);
  kFlutterRows[row.value_or(best_simd_row())].flutter(
      {.count = noise.size(),
       .noise = noise.data(),
       .along = along.data(),
       .across = across.data(),
       .lean_rad = static_cast<float>(lean_rad),
       .flutter_rad = static_cast<float>(flutter_rad),
       .toward_east = static_cast<float>(response.strength * response.toward_east),
       .toward_south = static_cast<float>(response.strength * response.toward_south),
       .out_east_rad = bend_east_rad.data(),
       .out_south_rad = bend_south_rad.data()});
  return Problem::kNone;
}

}  // namespace yuragi
