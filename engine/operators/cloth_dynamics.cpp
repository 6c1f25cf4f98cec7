#include "engine/operators/cloth_dynamics.hpp"

#include <algorithm>
#include <cmath>

#include "engine/base/kernel.hpp"
#include "engine/operators/cloth_dynamics_kernels.hpp"

namespace yuragi::operators {
namespace {

constexpr KernelRows<ClothDynamicsKernels> kDynamicsRows = YURAGI_KERNEL_ROWS(cloth_dynamics_kernels);

constexpr double kGravity_m_s2 = 9.81;
constexpr double kMaxSubstep_s = 1.0 / 600.0;
constexpr double kMaxTick_s = 0.1;

constexpr float kAtRest_m = 2e-5F;
constexpr float kAtRest_m_s = 2e-4F;
constexpr float kTiniest_m_s = 1e-6F;

/// Of a spring: times the substep squared it is far below 4, above which explicit steps are unstable.
constexpr double kStiffest_s2 = 0.2 / (kMaxSubstep_s * kMaxSubstep_s);

/// The value at a place between two columns' values.
double between_columns(std::span<const float> values, double at) {
  const auto first = std::min(static_cast<std::size_t>(at), values.size() - 1);
  const std::size_t second = std::min(first + 1, values.size() - 1);
  const double part = at - static_cast<double>(first);
  return (1.0 - part) * static_cast<double>(values[first]) + part * static_cast<double>(values[second]);
}

double edge_length_m(std::span<const float> x_m, std::span<const float> y_m, std::span<const float> z_m,
                     std::size_t columns) {
  const auto way = [columns](std::span<const float> at_m) {
    return static_cast<double>(at_m[columns - 1]) - static_cast<double>(at_m[0]);
  };
  return std::sqrt(way(x_m) * way(x_m) + way(y_m) * way(y_m) + way(z_m) * way(z_m));
}

/// The number of columns for a distance of about `apart_m`.
std::size_t coarse_columns(std::size_t columns, double edge_m, double apart_m) {
  const auto most = static_cast<double>(std::min(columns, CoarseCloth::kMaxColumns));
  return static_cast<std::size_t>(std::clamp(std::nearbyint(edge_m / apart_m) + 1.0, 2.0, most));
}

double threads_length_m(const ClothThreads& threads) {
  return static_cast<double>(threads.link_length_m) * static_cast<double>(threads.links);
}

bool is_from(double value, double low, double high) noexcept {
  return value >= low && value <= high;
}

bool all_below(std::span<const float> values, float limit) noexcept {
  return std::all_of(values.begin(), values.end(), [limit](float value) { return std::abs(value) < limit; });
}

}  // namespace

CoarseCloth::CoarseCloth(const ClothThreads& threads, std::size_t columns, std::span<const float> edge_x_m,
                         std::span<const float> edge_y_m, std::span<const float> edge_z_m, bool is_first_column_fixed)
    : rows_(std::clamp<std::size_t>(threads.links + 1, 2, kMaxRows)),
      columns_(coarse_columns(columns, edge_length_m(edge_x_m, edge_y_m, edge_z_m, columns),
                              threads_length_m(threads) / static_cast<double>(rows_ - 1))),
      stride_(pose::padded_to_blocks(columns_ + 2)),
      is_first_column_fixed_(is_first_column_fixed),
      link_length_m_(threads.link_length_m * static_cast<float>(threads.links) / static_cast<float>(rows_ - 1)),
      rest_link_m_(3 * stride_),
      across_m_(3 * stride_),
      across_growth_m_(3 * stride_),
      rest_length_m_(stride_),
      skin_share_(stride_, 0.0F),
      mobility_(stride_, 1.0F),
      offset_m_(3 * rows_ * stride_ + pose::kStrandsPerBlock, 0.0F),
      predicted_m_(3 * rows_ * stride_, 0.0F),
      speed_m_s_(3 * rows_ * stride_, 0.0F),
      lean_(2 * (rows_ - 1) * stride_, 0.0F) {
  // The threads' values at the coarse columns; ghosts have those of their neighbours.
  const double links_in_one = static_cast<double>(threads.links) / static_cast<double>(rows_ - 1);
  const std::span<const float> fine(threads.rest_end_m);
  const auto fine_place = [&](std::size_t i) {
    const std::size_t column = std::clamp<std::size_t>(i, 1, columns_) - 1;
    return static_cast<double>(column) * static_cast<double>(columns - 1) / static_cast<double>(columns_ - 1);
  };
  for (std::size_t i = 0; i < stride_; ++i) {
    const double at = fine_place(i);
    const double down_m = between_columns(fine.subspan(threads.stride, columns), at);
    const auto length_m = static_cast<double>(threads.link_length_m);
    rest_link_m_[i] = static_cast<float>(links_in_one * between_columns(fine.first(columns), at));
    rest_link_m_[stride_ + i] = static_cast<float>(links_in_one * (length_m - down_m));
    rest_link_m_[2 * stride_ + i] =
        static_cast<float>(links_in_one * between_columns(fine.subspan(2 * threads.stride, columns), at));
  }

  // Exact, so that the kernel recognises a link at rest.
  for (std::size_t i = 0; i < stride_; ++i) {
    const float x_m = rest_link_m_[i];
    const float y_m = rest_link_m_[stride_ + i];
    const float z_m = rest_link_m_[2 * stride_ + i];
    rest_length_m_[i] = std::sqrt(x_m * x_m + (y_m * y_m + z_m * z_m));
  }

  // From the previous to the next column, for the normals.
  for (std::size_t i = 1; i + 1 < stride_; ++i) {
    const std::span<const float> edges[] = {edge_x_m, edge_y_m, edge_z_m};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const std::span<const float> edge = edges[axis].first(columns);
      const std::size_t at = axis * stride_ + i;
      across_m_[at] =
          static_cast<float>(between_columns(edge, fine_place(i + 1)) - between_columns(edge, fine_place(i - 1)));
      across_growth_m_[at] = rest_link_m_[at + 1] - rest_link_m_[at - 1];
    }
  }
  if (is_first_column_fixed_) mobility_[0] = mobility_[1] = 0.0F;
}

ClothDynamicsJob::Problem ClothDynamicsJob::validate() const noexcept {
  if (cloth == nullptr) return Problem::kNoCloth;
  if (!std::isfinite(dt_s) || !(dt_s > 0.0)) return Problem::kStepNotPositive;
  if (!is_from(normal_drag_per_m, 0.0, 1e3) || !is_from(skin_drag_per_m, 0.0, 1e3) ||
      !is_from(across_stiffness_s2, 0.0, 20'000.0) || !is_from(damping_per_s, 0.0, 100.0) ||
      !is_from(largest_speed_m_s, 1e-3, 1e3) || !is_from(largest_lean_per_s, 1e-3, 1e3)) {
    return Problem::kParameter;
  }
  if (air_east_m_s.size() != cloth->stride() || air_south_m_s.size() != cloth->stride()) return Problem::kSizesDiffer;
  if (row && !is_runnable(*row)) return Problem::kRowNotRunnable;
  return Problem::kNone;
}

ClothDynamicsJob::Problem ClothDynamicsJob::run() const noexcept {
  const Problem problem = validate();
  if (problem != Problem::kNone) return problem;
  const double tick_s = std::min(dt_s, kMaxTick_s);
  const double substeps = std::max(std::ceil(tick_s / kMaxSubstep_s - 1e-6), 1.0);
  const double substep_s = tick_s / substeps;

  // The tension of a link of a hanging thread, from the weight below it; if the links are so short that it would be too
  // stiff, all tensions are reduced.
  const auto links = static_cast<double>(cloth->links());
  const double weight_s2 = std::min(kGravity_m_s2 / static_cast<double>(cloth->link_length_m()), kStiffest_s2 / links);
  const std::size_t stride = cloth->stride();

  // The skin's drag, also implicit: the relative speed is nearly the air's.
  for (std::size_t i = 0; i < stride; ++i) {
    const auto east_m_s = static_cast<double>(air_east_m_s[i]);
    const auto south_m_s = static_cast<double>(air_south_m_s[i]);
    const double way_m = std::sqrt(east_m_s * east_m_s + south_m_s * south_m_s) * substep_s;
    cloth->skin_share_[i] = static_cast<float>(1.0 - 1.0 / (1.0 + skin_drag_per_m * way_m));
  }
  kDynamicsRows[row.value_or(best_simd_row())].step({
      .stride = stride,
      .rows = cloth->rows(),
      .columns = cloth->columns(),
      .substeps = static_cast<std::size_t>(substeps),
      .substep_s = static_cast<float>(substep_s),
      .weight_s2 = static_cast<float>(weight_s2),
      .across_s2 = static_cast<float>(across_stiffness_s2),
      .normal_drag = static_cast<float>(normal_drag_per_m * substep_s),
      .speed_kept = static_cast<float>(std::exp(-damping_per_s * substep_s)),
      .largest_speed_m_s = static_cast<float>(largest_speed_m_s),
      .largest_lean_step = static_cast<float>(largest_lean_per_s * tick_s),
      .rest_link_m = cloth->rest_link_m_.data(),
      .rest_length_m = cloth->rest_length_m_.data(),
      .skin_share = cloth->skin_share_.data(),
      .across_m = cloth->across_m_.data(),
      .across_growth_m = cloth->across_growth_m_.data(),
      .mobility = cloth->mobility_.data(),
      .air_east_m_s = air_east_m_s.data(),
      .air_south_m_s = air_south_m_s.data(),
      .offset_m = cloth->offset_m_.data(),
      .predicted_m = cloth->predicted_m_.data(),
      .speed_m_s = cloth->speed_m_s_.data(),
      .lean = cloth->lean_.data(),
  });

  // In still air, slow movement is set to rest: the remainder would be rounding.
  if (all_below(air_east_m_s, kTiniest_m_s) && all_below(air_south_m_s, kTiniest_m_s) &&
      all_below(cloth->speed_m_s_, kAtRest_m_s) && all_below(cloth->offset_m_, kAtRest_m)) {
    std::fill(cloth->speed_m_s_.begin(), cloth->speed_m_s_.end(), 0.0F);
    std::fill(cloth->offset_m_.begin(), cloth->offset_m_.end(), 0.0F);
  }

  // A spline through the ghosts is 0 on a fixed column, and continues level elsewhere.
  for (std::size_t line = 0; line < 2 * cloth->links(); ++line) {
    float* const lean = cloth->lean_.data() + line * stride;
    lean[0] = cloth->is_first_column_fixed() ? -lean[2] : lean[1];
    for (std::size_t i = cloth->columns() + 1; i < stride; ++i) lean[i] = lean[cloth->columns()];
  }
  return Problem::kNone;
}

}  // namespace yuragi::operators
