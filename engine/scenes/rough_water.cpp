#include "engine/scenes/rough_water.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

#include "engine/noise/torus.hpp"
#include "engine/operators/grid_sample_job.hpp"
#include "engine/scenes/scene.hpp"

namespace yuragi::scenes {
namespace {

constexpr double kStillSlopes = 0.003;
constexpr double kSlopesPerWind_s_m = 0.00512;
constexpr std::size_t kMaxWaterCells = 62;  ///< a side: with one more node, and one to read beyond, 64

/// A smaller slope is set to 0: it moves nothing, and would become a denormal number.
constexpr float kFlatSlope = 1e-12F;

std::size_t cells_over(double extent_m, double finest_cell_m) {
  const double cells = std::ceil(std::min(extent_m / finest_cell_m, 1e6));
  return std::clamp(static_cast<std::size_t>(cells), std::size_t{1}, kMaxWaterCells);
}

/// The positions of `points`, evenly from the first node to the last, on a torus of `size` nodes.
std::vector<std::uint32_t> phases_between(std::size_t points, std::size_t nodes, std::size_t size) {
  std::vector<std::uint32_t> phases;
  for (std::size_t i = 0; i < points; ++i) {
    const double node = static_cast<double>(i * (nodes - 1)) / static_cast<double>(points - 1);
    phases.push_back(noise::torus_phase(node, static_cast<double>(size)));
  }
  return phases;
}

}  // namespace

double water_slope_variance(double wind_m_s, double onset_m_s) noexcept {
  const double of_onset = wind_m_s / onset_m_s;
  const double square = of_onset * of_onset;
  const double y_8 = 1.0 + square * square / 8.0;
  const double y_16 = y_8 * y_8;
  const double y_32 = y_16 * y_16;
  return (kStillSlopes + kSlopesPerWind_s_m * wind_m_s) * (1.0 - 1.0 / (y_32 * y_32));
}

RoughWater::RoughWater(const RoughWaterSpec& spec)
    : spec_(spec),
      node_columns_(cells_over(spec.width_m, spec.finest_cell_m) + 1),
      node_rows_(cells_over(spec.depth_m, spec.finest_cell_m) + 1),
      value_(node_columns_ * node_rows_, 0.0F),
      rate_per_s_(value_.size(), 0.0F) {
  const std::size_t size = std::bit_ceil(std::max(node_columns_, node_rows_) + 1);
  on_torus_.size = size;
  on_torus_.values.assign(size * size, 0.0F);
  column_x_ = phases_between(spec.columns, node_columns_, size);
  row_z_ = phases_between(spec.rows, node_rows_, size);
}

double RoughWater::largest_slope() const noexcept {
  return std::sqrt(spec_.part * water_slope_variance(kStrongestSceneWind_m_s, spec_.onset_m_s));
}

void RoughWater::step(std::span<const float> wind_m_s, double dt_s) noexcept {
  // CriticallyDamped, for all nodes at once.
  const double phase = kBuildUp_rad_s * dt_s;
  const double decay = std::exp(-phase);
  const auto value_from_distance = static_cast<float>(decay * (1.0 + phase));
  const auto value_from_rate = static_cast<float>(decay * dt_s);
  const auto rate_from_rate = static_cast<float>(decay * (1.0 - phase));
  const auto rate_from_distance = static_cast<float>(-decay * kBuildUp_rad_s * phase);
  for (std::size_t i = 0; i < value_.size(); ++i) {
    const double wind = std::clamp(static_cast<double>(wind_m_s[i]), 0.0, kStrongestSceneWind_m_s);
    const auto target = static_cast<float>(std::sqrt(spec_.part * water_slope_variance(wind, spec_.onset_m_s)));
    const float distance = value_[i] - target;
    const float rate = rate_per_s_[i];
    const float value = target + value_from_distance * distance + value_from_rate * rate;
    const float new_rate = rate_from_rate * rate + rate_from_distance * distance;
    const bool is_flat = target < kFlatSlope && std::abs(value) < kFlatSlope && std::abs(new_rate) < kFlatSlope;
    value_[i] = is_flat ? 0.0F : value;
    rate_per_s_[i] = is_flat ? 0.0F : new_rate;
  }
  for (std::size_t row = 0; row < node_rows_; ++row) {
    std::copy_n(value_.begin() + static_cast<std::ptrdiff_t>(row * node_columns_), node_columns_,
                on_torus_.values.begin() + static_cast<std::ptrdiff_t>(row * on_torus_.size));
  }
}

void RoughWater::sample(SimdRow row, std::span<float> slope) const noexcept {
  const operators::GridNoiseLayer layer{.tile = &on_torus_, .column_x = column_x_, .row_z = row_z_};
  operators::GridSampleJob{.layers = std::span(&layer, 1), .row = row, .out = slope}.run();
}

}  // namespace yuragi::scenes
