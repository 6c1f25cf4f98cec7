#include "engine/operators/tilt_job.hpp"

#include <cmath>

#include "engine/base/kernel.hpp"
#include "engine/base/units.hpp"
#include "engine/operators/crown_kernels.hpp"
#include "engine/operators/wind_response.hpp"

namespace yuragi {
namespace {

constexpr KernelRows<CrownKernels> kTiltRows = YURAGI_KERNEL_ROWS(crown_kernels);

}  // namespace

TiltJob::Problem TiltJob::validate() const noexcept {
  if (!std::isfinite(wind_east_m_s * wind_east_m_s + wind_south_m_s * wind_south_m_s)) return Problem::kWindNotFinite;
  if (!std::isfinite(half_tilt_speed_m_s) || half_tilt_speed_m_s < kSlowestResponseSpeed_m_s) {
    return Problem::kHalfTiltSpeed;
  }
  if (!std::isfinite(alpha_vertical) || !std::isfinite(beta_horizontal)) return Problem::kConstants;
  if (!(max_tilt_rad >= 0.0 && max_tilt_rad <= kPi && max_swing_rad >= 0.0 && max_swing_rad <= kPi)) {
    return Problem::kLargestAngles;
  }
  const std::size_t count = vertical.size();
  for (const std::size_t size :
       {horizontal.size(), distance.size(), gain.size(), bend_east_rad.size(), bend_south_rad.size()}) {
    if (size != count) return Problem::kSizesDiffer;
  }
  if (row && !is_runnable(*row)) return Problem::kRowNotRunnable;
  return Problem::kNone;
}

TiltJob::Problem TiltJob::run() const noexcept {
  const Problem problem = validate();
  if (problem != Problem::kNone) return problem;
  const auto response = WindResponse::to(wind_east_m_s, wind_south_m_s, half_tilt_speed_m_s);
  kTiltRows[row.value_or(best_simd_row())].tilt({.count = vertical.size(),
                                                 .vertical = vertical.data(),
                                                 .horizontal = horizontal.data(),
                                                 .distance = distance.data(),
                                                 .gain = gain.data(),
                                                 .response = static_cast<float>(response.strength),
                                                 .toward_east = static_cast<float>(response.toward_east),
                                                 .toward_south = static_cast<float>(response.toward_south),
                                                 .alpha_vertical = static_cast<float>(alpha_vertical),
                                                 .beta_horizontal = static_cast<float>(beta_horizontal),
                                                 .max_tilt_rad = static_cast<float>(max_tilt_rad),
                                                 .max_swing_rad = static_cast<float>(max_swing_rad),
                                                 .out_east_rad = bend_east_rad.data(),
                                                 .out_south_rad = bend_south_rad.data()});
  return Problem::kNone;
}

}  // namespace yuragi
