#include "engine/scenes/cloth_waves.hpp"

#include <algorithm>
#include <cmath>

namespace yuragi::scenes {
namespace {

/// Brings the difference over half a wave back to variance 1: it is 2 - 2 J0(pi) of a noise whose waves have all
/// directions and that length.
constexpr float kUnitDifference = 0.619F;

/// Half the length of a wave in the middle of the band, in rows.
std::size_t half_wave_rows(double shortest_m, double longest_m, double step_m) {
  const double half_wave_m = 0.5 * std::sqrt(shortest_m * longest_m);
  return static_cast<std::size_t>(std::max(std::nearbyint(half_wave_m / step_m), 1.0));
}

}  // namespace

ClothWaves::ClothWaves(double shortest_m, double longest_m, const ClothWaveGrid& grid, std::uint64_t seed, SimdRow row)
    : noise_(shortest_m, longest_m, seed, row),
      count_(grid.rows * grid.across_m.size()),
      behind_(half_wave_rows(shortest_m, longest_m, grid.step_m) * grid.across_m.size()) {
  // The rows before the first are those that the first are compared with.
  std::vector<float> along_m;
  std::vector<float> across_m;
  const std::size_t before = behind_ / grid.across_m.size();
  for (std::size_t i = 0; i < before + grid.rows; ++i) {
    const double steps = static_cast<double>(i) - static_cast<double>(before);
    for (const float column_m : grid.across_m) {
      along_m.push_back(
          static_cast<float>(grid.first_m + steps * grid.step_m - grid.slant * static_cast<double>(column_m)));
    }
    across_m.insert(across_m.end(), grid.across_m.begin(), grid.across_m.end());
  }
  places_ = noise_.places(along_m, across_m);
  values_.resize(along_m.size());
}

void ClothWaves::sample() noexcept {
  noise_.read(places_, values_);
  for (std::size_t i = 0; i < count_; ++i) {
    values_[i] = ClothNoise::saturated(kUnitDifference * (values_[i + behind_] - values_[i]));
  }
}

double ClothWaves::largest_change(double speed_m_s, double dt_s) const noexcept {
  const double of_both = 2.0 * static_cast<double>(kUnitDifference) * noise_.largest_read_change(speed_m_s, dt_s);
  return std::min(of_both, 2.0 * ClothNoise::kLargest);
}

}  // namespace yuragi::scenes
