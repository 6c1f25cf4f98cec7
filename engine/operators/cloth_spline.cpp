#include "engine/operators/cloth_spline.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "engine/base/kernel.hpp"
#include "engine/operators/cloth_dynamics_kernels.hpp"
#include "engine/operators/cloth_kernels.hpp"
#include "engine/pose/skeleton.hpp"

namespace yuragi::operators {
namespace {

constexpr KernelRows<ClothDynamicsKernels> kSplineRows = YURAGI_KERNEL_ROWS(cloth_dynamics_kernels);
constexpr KernelRows<ClothKernels> kLineRows = YURAGI_KERNEL_ROWS(cloth_kernels);

/// The weights of four neighbouring values; outside [0, last] the value at the end is used.
struct Taps {
  std::array<std::size_t, 4> at;
  std::array<float, 4> weight;
};

Taps taps_at(double place, std::size_t last) {
  const double cell = std::floor(place);
  const double t = place - cell;
  const std::array weights = {(1.0 - t) * (1.0 - t) * (1.0 - t) / 6.0, (3.0 * t * t * t - 6.0 * t * t + 4.0) / 6.0,
                              (-3.0 * t * t * t + 3.0 * t * t + 3.0 * t + 1.0) / 6.0, t * t * t / 6.0};
  Taps taps{};
  for (std::size_t i = 0; i < 4; ++i) {
    taps.at[i] =
        static_cast<std::size_t>(std::clamp(cell - 1.0 + static_cast<double>(i), 0.0, static_cast<double>(last)));
    taps.weight[i] = static_cast<float>(weights[i]);
  }
  return taps;
}

}  // namespace

ClothSpline::ClothSpline(const ClothKnots& knots, std::size_t columns, std::size_t links)
    : knots_(knots), width_(2 * pose::padded_to_blocks(columns)), links_(links) {
  // The first ghost is coarse column 0, so the first column of the cloth is at 1.
  const std::size_t stride = width_ / 2;
  const double coarse_per_fine =
      static_cast<double>(knots.columns - 1) / static_cast<double>(std::max<std::size_t>(columns - 1, 1));
  std::vector<Taps> taps;
  for (std::size_t i = 0; i < stride; ++i) {
    const double column = static_cast<double>(std::min(i, columns - 1));
    taps.push_back(taps_at(1.0 + coarse_per_fine * column, knots.columns + 1));
  }

  // As many taps for each block as the widest one needs, and none beyond the coarse row's end.
  const std::size_t blocks = stride / pose::kStrandsPerBlock;
  for (std::size_t block = 0; block < blocks; ++block) {
    const Taps& first = taps[block * pose::kStrandsPerBlock];
    const Taps& last = taps[(block + 1) * pose::kStrandsPerBlock - 1];
    taps_ = std::max(taps_, last.at[3] - first.at[0] + 1);
  }
  weights_.assign(blocks * taps_ * pose::kStrandsPerBlock, 0.0F);
  for (std::size_t block = 0; block < blocks; ++block) {
    first_.push_back(std::min(taps[block * pose::kStrandsPerBlock].at[0], knots.stride - taps_));
    for (std::size_t i = 0; i < pose::kStrandsPerBlock; ++i) {
      const Taps& of = taps[block * pose::kStrandsPerBlock + i];
      for (std::size_t tap = 0; tap < 4; ++tap) {
        weights_[(block * taps_ + of.at[tap] - first_[block]) * pose::kStrandsPerBlock + i] += of.weight[tap];
      }
    }
  }
  spread_.assign(knots.links * width_, 0.0F);
}

void ClothSpline::spread(std::span<const float> leans, SimdRow row) noexcept {
  if (leans.size() != knots_.size()) return;
  const auto spread_row = kSplineRows[row].spread;
  const std::size_t stride = width_ / 2;
  for (std::size_t line = 0; line < 2 * knots_.links; ++line) {
    spread_row({.blocks = stride / pose::kStrandsPerBlock,
                .taps = taps_,
                .first = first_.data(),
                .weights = weights_.data(),
                .coarse = leans.data() + line * knots_.stride,
                .fine = spread_.data() + line * stride});
  }
}

ClothSplineJob::Problem ClothSplineJob::validate() const noexcept {
  if (spline == nullptr) return Problem::kNoSpline;
  if (!std::isfinite(share)) return Problem::kShareNotFinite;
  if (out.size() % spline->width_ != 0 || first_link + out.size() / spline->width_ > spline->links_) {
    return Problem::kSizesDiffer;
  }
  if (row && !is_runnable(*row)) return Problem::kRowNotRunnable;
  return Problem::kNone;
}

ClothSplineJob::Problem ClothSplineJob::run() const noexcept {
  const Problem problem = validate();
  if (problem != Problem::kNone) return problem;
  const auto add = kSplineRows[row.value_or(best_simd_row())].add;
  const std::size_t width = spline->width_;
  const double coarse_per_fine = static_cast<double>(spline->knots_.links) / static_cast<double>(spline->links_);
  for (std::size_t i = 0; i < out.size() / width; ++i) {
    // A lean is that of a link's middle.
    const Taps taps =
        taps_at((static_cast<double>(first_link + i) + 0.5) * coarse_per_fine - 0.5, spline->knots_.links - 1);
    const auto coarse = [&](std::size_t tap) { return spline->spread_.data() + taps.at[tap] * width; };
    add({.count = width,
         .row = {coarse(0), coarse(1), coarse(2), coarse(3)},
         .weight = {share * taps.weight[0], share * taps.weight[1], share * taps.weight[2], share * taps.weight[3]},
         .out = out.data() + i * width});
  }
  return Problem::kNone;
}

ClothLineJob::Problem ClothLineJob::validate() const noexcept {
  if (spline == nullptr) return Problem::kNoSpline;
  const std::size_t width = spline->width_;
  if (base.size() != width || out.size() % width != 0 || first_link + out.size() / width > spline->links_) {
    return Problem::kSizesDiffer;
  }
  if (row && !is_runnable(*row)) return Problem::kRowNotRunnable;
  return Problem::kNone;
}

ClothLineJob::Problem ClothLineJob::run() const noexcept {
  const Problem problem = validate();
  if (problem != Problem::kNone) return problem;
  const auto mix = kLineRows[row.value_or(best_simd_row())].propagate;
  const std::size_t width = spline->width_;
  const double last = static_cast<double>(spline->knots_.links) - 1.0;
  const double coarse_per_fine = static_cast<double>(spline->knots_.links) / static_cast<double>(spline->links_);
  for (std::size_t i = 0; i < out.size() / width; ++i) {
    // A lean is that of a link's middle.
    const double place = std::clamp((static_cast<double>(first_link + i) + 0.5) * coarse_per_fine - 0.5, 0.0, last);
    const auto knot = static_cast<std::size_t>(place);
    const std::size_t next = std::min(knot + 1, spline->knots_.links - 1);
    const auto part = static_cast<float>(place - static_cast<double>(knot));
    mix({.count = width,
         .base = base.data(),
         .newer = spline->spread_.data() + knot * width,
         .older = spline->spread_.data() + next * width,
         .newer_gain = 1.0F - part,
         .older_gain = part,
         .out = out.data() + i * width});
  }
  return Problem::kNone;
}

}  // namespace yuragi::operators
