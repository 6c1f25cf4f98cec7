#include "engine/pose/quantise.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>

#include "engine/base/kernel.hpp"
#include "engine/pose/quantise_kernels.hpp"

namespace yuragi::pose {
namespace {

constexpr KernelRows<QuantiseKernels> kQuantiseRows = YURAGI_KERNEL_ROWS(quantise_kernels);

const QuantiseKernels& quantise_row(std::optional<SimdRow> row) noexcept {
  assert(!row || is_runnable(*row));
  return kQuantiseRows[row.value_or(best_simd_row())];
}

constexpr float kMaxUnit = 32767.0F;

constexpr std::size_t kExtentSamples = 16;  // along each side of a grid
constexpr float kFinestStep_m = 1e-6F;
constexpr float kCoarsestStep_m = 1.0F;

constexpr float kReachOfCloth = 2.0F;  // as a part of the extent
constexpr float kReachOfBody = 2.0F;
constexpr float kReachOfOpenSurface = 0.25F;

/// For a grid of columns x rows points whose rows are `stride` apart.
template <class Points>
float way_step_of(const Points& points, std::size_t columns, std::size_t rows, std::size_t stride,
                  float reach) noexcept {
  if (columns == 0 || rows == 0) return kFinestStep_m;
  float square_m2 = 0.0F;
  for (const auto* axis : {&points.rest_x_m, &points.rest_y_m, &points.rest_z_m}) {
    float least_m = axis->front();
    float most_m = least_m;
    for (std::size_t i = 0; i < kExtentSamples; ++i) {
      const std::size_t row = i * (rows - 1) / (kExtentSamples - 1);
      for (std::size_t k = 0; k < kExtentSamples; ++k) {
        const float at_m = (*axis)[row * stride + k * (columns - 1) / (kExtentSamples - 1)];
        least_m = std::min(least_m, at_m);
        most_m = std::max(most_m, at_m);
      }
    }
    square_m2 += (most_m - least_m) * (most_m - least_m);
  }
  return std::clamp(reach * std::sqrt(square_m2) / kMaxUnit, kFinestStep_m, kCoarsestStep_m);
}

}  // namespace

void quantise(std::span<const float> angle_rad, std::span<std::int16_t> units, std::optional<SimdRow> row) noexcept {
  assert(angle_rad.size() == units.size());
  quantise_row(row).to_int16({.count = units.size(),
                              .values = angle_rad.data(),
                              .units_per_one = kMaxUnit / 0x1.921fb6p1F,
                              .smallest = -kMaxUnit,
                              .largest = kMaxUnit,
                              .units = units.data()});
}

void quantise_ways(std::span<const float> way_m, float step_m, std::span<std::int16_t> units,
                   std::optional<SimdRow> row) noexcept {
  assert(way_m.size() == units.size());
  quantise_row(row).to_int16({.count = units.size(),
                              .values = way_m.data(),
                              .units_per_one = 1.0F / step_m,
                              .smallest = -kMaxUnit,
                              .largest = kMaxUnit,
                              .units = units.data()});
}

void quantise_heat(std::span<const float> heat, std::span<std::uint8_t> units, std::optional<SimdRow> row) noexcept {
  assert(heat.size() == units.size());
  quantise_row(row).to_uint8({.count = units.size(),
                              .values = heat.data(),
                              .units_per_one = 255.0F,
                              .smallest = 0.0F,
                              .largest = 255.0F,
                              .units = units.data()});
}

float way_step_m(const GridSkeleton& grid) noexcept {
  return way_step_of(grid, grid.columns, grid.rows, grid.stride(), kReachOfCloth);
}

float way_step_m(const SurfaceSkeleton& surface) noexcept {
  return way_step_of(surface, surface.columns, surface.rows, surface.columns,
                     surface.is_closed ? kReachOfBody : kReachOfOpenSurface);
}

}  // namespace yuragi::pose
