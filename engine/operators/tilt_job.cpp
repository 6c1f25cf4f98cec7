#include "engine/operators/tilt_job.hpp"

#include <cmath>

#include "engine/base/kernel.hpp"
#include "engine/base/units.hpp"
#include "engine/operators/crown_kernels.hpp"

namespace yuragi::operators {
namespace {

constexpr KernelRows<CrownKernels> kTiltRows = YURAGI_KERNEL_ROWS(crown_kernels);

}  // namespace

TiltJob::Problem TiltJob::validate() const noexcept {
  if (!(force >= 0.0 && force <= 1e6)) return Problem::kForce;
  if (!std::isfinite(alpha_vertical) || !std::isfinite(beta_horizontal)) return Problem::kConstants;
  if (!(max_tilt_rad >= 0.0 && max_tilt_rad <= kPi && max_swing_rad >= 0.0 && max_swing_rad <= kPi)) {
    return Problem::kMaxAngles;
  }
  const std::size_t count = vertical.size();
  for (const std::size_t size : {toward_east.size(), toward_south.size(), horizontal.size(), distance.size(),
                                 gain.size(), bend_east_rad.size(), bend_south_rad.size()}) {
    if (size != count) return Problem::kSizesDiffer;
  }
  if (row && !is_runnable(*row)) return Problem::kRowNotRunnable;
  return Problem::kNone;
}

TiltJob::Problem TiltJob::run() const noexcept {
  const Problem problem = validate();
  if (problem != Problem::kNone) return problem;
  kTiltRows[row.value_or(best_simd_row())].tilt({.count = vertical.size(),
                                                 .force = static_cast<float>(force),
                                                 .toward_east = toward_east.data(),
                                                 .toward_south = toward_south.data(),
                                                 .vertical = vertical.data(),
                                                 .horizontal = horizontal.data(),
                                                 .distance = distance.data(),
                                                 .gain = gain.data(),
                                                 .alpha_vertical = static_cast<float>(alpha_vertical),
                                                 .beta_horizontal = static_cast<float>(beta_horizontal),
                                                 .max_tilt_rad = static_cast<float>(max_tilt_rad),
                                                 .max_swing_rad = static_cast<float>(max_swing_rad),
                                                 .out_east_rad = bend_east_rad.data(),
                                                 .out_south_rad = bend_south_rad.data()});
  return Problem::kNone;
}

}  // namespace yuragi::operators
