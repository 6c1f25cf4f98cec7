#include "engine/scenes/carried_noise.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "engine/math/philox.hpp"
#include "engine/operators/sample_job.hpp"
#include "engine/operators/shift_job.hpp"

namespace yuragi {
namespace {

// The second tile against the first: turned by one radian (its cosine and sine, written out so that no library's
// rounding decides about bits), and smaller by the golden ratio.
constexpr double kTurnCos = 0x1.14a280fb5068cp-1;
constexpr double kTurnSin = 0x1.aed548f090ceep-1;
constexpr double kPeriodRatio = 1.0 / std::numbers::phi;

NoiseTile2 make_tile(const CarriedNoiseSpec& spec, std::uint64_t which) {
  return make_noise_2d({.size = spec.samples, .beta = spec.beta, .meaning = spec.meaning, .seed = spec.seed ^ which})
      .value();
}

/// The steepest slope of a tile read bilinearly, in any direction, a metre.
double steepest_slope(const NoiseTile2& tile, double period_m) {
  float along_x = 0.0F;
  float along_z = 0.0F;
  for (std::size_t z = 0; z < tile.size; ++z) {
    for (std::size_t x = 0; x < tile.size; ++x) {
      along_x = std::max(along_x, std::abs(tile.at((x + 1) % tile.size, z) - tile.at(x, z)));
      along_z = std::max(along_z, std::abs(tile.at(x, (z + 1) % tile.size) - tile.at(x, z)));
    }
  }
  const double cells_per_m = static_cast<double>(tile.size) / period_m;
  return std::hypot(static_cast<double>(along_x), static_cast<double>(along_z)) * cells_per_m;
}

void add_phases(std::span<const float> x_m, std::span<const float> z_m, double cos, double sin, double period_m,
                std::vector<std::uint32_t>& x, std::vector<std::uint32_t>& z) {
  for (std::size_t i = 0; i < x_m.size(); ++i) {
    const auto at_x = static_cast<double>(x_m[i]);
    const auto at_z = static_cast<double>(z_m[i]);
    x.push_back(torus_phase(cos * at_x - sin * at_z, period_m));
    z.push_back(torus_phase(sin * at_x + cos * at_z, period_m));
  }
}

}  // namespace

CarriedNoise::CarriedNoise(const CarriedNoiseSpec& spec)
    : has_two_tiles_(spec.has_two_tiles),
      weight_(spec.has_two_tiles ? 0x1.6a09e6p-1F : 1.0F),  // 1 / sqrt(2): variances add up to 1
      first_{make_tile(spec, stream_id("first tile")), spec.period_m, {}} {
  if (has_two_tiles_) second_ = {make_tile(spec, stream_id("second tile")), spec.period_m * kPeriodRatio, {}};

  for (std::size_t i = 0; i < tile_count(); ++i) {
    const Tile& tile = i == 0 ? first_ : second_;
    const auto weight = static_cast<double>(weight_);
    const auto [low, high] = std::minmax_element(tile.noise.values.begin(), tile.noise.values.end());
    lowest_ += weight * static_cast<double>(*low);
    highest_ += weight * static_cast<double>(*high);
    steepest_per_m_ += weight * steepest_slope(tile.noise, tile.period_m);
  }
}

CarriedPlaces CarriedNoise::places(std::span<const float> x_m, std::span<const float> z_m) const {
  CarriedPlaces places;
  add_phases(x_m, z_m, 1.0, 0.0, first_.period_m, places.first_x, places.first_z);
  if (has_two_tiles_) {
    add_phases(x_m, z_m, kTurnCos, kTurnSin, second_.period_m, places.second_x, places.second_z);
  }
  return places;
}

void CarriedNoise::shift(double toward_x_m_s, double toward_z_m_s, double dt_s) noexcept {
  ShiftJob{.wind_east_m_s = toward_x_m_s,
           .wind_south_m_s = toward_z_m_s,
           .dt_s = dt_s,
           .period_m = first_.period_m,
           .offset = &first_.offset}
      .run();
  if (!has_two_tiles_) return;
  ShiftJob{.wind_east_m_s = kTurnCos * toward_x_m_s - kTurnSin * toward_z_m_s,
           .wind_south_m_s = kTurnSin * toward_x_m_s + kTurnCos * toward_z_m_s,
           .dt_s = dt_s,
           .period_m = second_.period_m,
           .offset = &second_.offset}
      .run();
}

void CarriedNoise::sample(const CarriedPlaces& places, SimdRow row, std::span<float> out, float scale, float bias,
                          float low, float high) const noexcept {
  const std::array<NoiseLayer, 2> layers = {{{.tile = &first_.noise,
                                              .place_x = places.first_x,
                                              .place_z = places.first_z,
                                              .offset = first_.offset.phase(),
                                              .weight = weight_},
                                             {.tile = &second_.noise,
                                              .place_x = places.second_x,
                                              .place_z = places.second_z,
                                              .offset = second_.offset.phase(),
                                              .weight = weight_}}};
  SampleJob{.layers = std::span(layers).first(tile_count()),
            .scale = scale,
            .bias = bias,
            .low = low,
            .high = high,
            .row = row,
            .out = out}
      .run();
}

double CarriedNoise::largest_change(double distance_m) const noexcept {
  return std::min(steepest_per_m_ * distance_m, highest_ - lowest_);
}

}  // namespace yuragi
