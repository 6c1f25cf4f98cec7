#include "engine/operators/propagation_job.hpp"

#include <cmath>

#include "engine/base/kernel.hpp"
#include "engine/operators/cloth_kernels.hpp"

namespace yuragi::operators {
namespace {

constexpr KernelRows<ClothKernels> kPropagationRows = YURAGI_KERNEL_ROWS(cloth_kernels);

}  // namespace

PropagationJob::Problem PropagationJob::validate() const noexcept {
  if (history == nullptr) return Problem::kNoHistory;
  if (!std::isfinite(travel_time_s) || travel_time_s < 0.0) return Problem::kTravelTime;
  const std::size_t width = history->width();
  if (width == 0 || base.size() != width || out.size() % width != 0) return Problem::kSizesDiffer;
  if (first_link + out.size() / width > growth.size()) return Problem::kNotALink;
  if (row && !is_runnable(*row)) return Problem::kRowNotRunnable;
  return Problem::kNone;
}

PropagationJob::Problem PropagationJob::run() const noexcept {
  const Problem problem = validate();
  if (problem != Problem::kNone) return problem;
  const auto propagate = kPropagationRows[row.value_or(best_simd_row())].propagate;
  const std::size_t width = history->width();
  const double delay_a_link_s = growth.size() > 1 ? travel_time_s / static_cast<double>(growth.size() - 1) : 0.0;
  for (std::size_t i = 0; i < out.size() / width; ++i) {
    const std::size_t link = first_link + i;
    const PropagationHistory::Between past = history->at(delay_a_link_s * static_cast<double>(link));
    propagate({.count = width,
               .base = base.data(),
               .newer = past.newer,
               .older = past.older,
               .newer_gain = growth[link] * (1.0F - past.fraction),
               .older_gain = growth[link] * past.fraction,
               .out = out.data() + i * width});
  }
  return Problem::kNone;
}

}  // namespace yuragi::operators
