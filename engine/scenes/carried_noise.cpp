#include "engine/scenes/carried_noise.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <numbers>
#include <utility>

#include "engine/math/philox.hpp"
#include "engine/math/portable.hpp"
#include "engine/noise/line_cut.hpp"
#include "engine/noise/unit_reading.hpp"
#include "engine/operators/sample_job.hpp"
#include "engine/operators/shift_job.hpp"

namespace yuragi::scenes {
namespace {

// The second tile, relative to the first: turned by one radian (its cosine and sine, written out so that no library's
// rounding changes bits), and larger by the golden ratio.
constexpr double kTurnCos = 0x1.14a280fb5068cp-1;
constexpr double kTurnSin = 0x1.aed548f090ceep-1;
constexpr double kPeriodRatio = std::numbers::phi;

bool is_lone_band(const CarriedNoiseSpec& spec) {
  return spec.shortest_m > 0.0 && !spec.has_two_tiles;
}

double largest_difference(const noise::Tile2& a, const noise::Tile2& b) {
  float largest = 0.0F;
  for (std::size_t i = 0; i < a.values.size(); ++i) largest = std::max(largest, std::abs(a.values[i] - b.values[i]));
  return static_cast<double>(largest);
}

void add_phases(std::span<const float> x_m, std::span<const float> z_m, double cos, double sin, double period_m,
                std::vector<std::uint32_t>& x, std::vector<std::uint32_t>& z) {
  for (std::size_t i = 0; i < x_m.size(); ++i) {
    const auto at_x = static_cast<double>(x_m[i]);
    const auto at_z = static_cast<double>(z_m[i]);
    x.push_back(noise::torus_phase(cos * at_x - sin * at_z, period_m));
    z.push_back(noise::torus_phase(sin * at_x + cos * at_z, period_m));
  }
}

}  // namespace

double steepest_slope(const noise::Tile2& tile, double period_m) noexcept {
  float along_x = 0.0F;
  float along_z = 0.0F;
  for (std::size_t z = 0; z < tile.size; ++z) {
    for (std::size_t x = 0; x < tile.size; ++x) {
      along_x = std::max(along_x, std::abs(tile.at((x + 1) % tile.size, z) - tile.at(x, z)));
      along_z = std::max(along_z, std::abs(tile.at(x, (z + 1) % tile.size) - tile.at(x, z)));
    }
  }
  const double cells_per_m = static_cast<double>(tile.size) / period_m;
  return math::length(static_cast<double>(along_x), static_cast<double>(along_z)) * cells_per_m;
}

CarriedNoise::Tile CarriedNoise::make_tile(const CarriedNoiseSpec& spec, std::uint64_t which, double period_m) {
  const bool is_band = spec.shortest_m > 0.0;
  noise::Tile2 noise = noise::make_noise_2d({.size = spec.samples,
                                             .beta = spec.beta,
                                             .meaning = spec.meaning,
                                             .seed = spec.seed ^ which,
                                             .from_cycles = period_m / spec.longest_m,
                                             .to_cycles = period_m / spec.shortest_m})
                           .value();
  if (is_band) noise::scale_to_unit_reading(noise);
  Tile tile{.noise = is_band ? noise::BandLimitedTile2(std::move(noise), 1) : noise::BandLimitedTile2(std::move(noise)),
            .period_m = period_m};
  for (std::size_t level = 0; level < tile.noise.level_count(); ++level) {
    tile.steepest_per_m.push_back(steepest_slope(tile.noise.level(level), period_m));
    if (level == 0) continue;
    tile.largest_octave =
        std::max(tile.largest_octave, largest_difference(tile.noise.level(level - 1), tile.noise.level(level)));
  }
  return tile;
}

CarriedNoise::CarriedNoise(const CarriedNoiseSpec& spec)
    : turn_cos_(is_lone_band(spec) ? noise::LineCut::kEast : 1.0),
      turn_sin_(is_lone_band(spec) ? noise::LineCut::kSouth : 0.0),
      weight_(spec.has_two_tiles ? 0x1.6a09e6p-1F : 1.0F) {  // 1 / sqrt(2): variances add up to 1
  tiles_.push_back(make_tile(spec, math::stream_id("first tile"), spec.period_m));
  if (spec.has_two_tiles)
    tiles_.push_back(make_tile(spec, math::stream_id("second tile"), spec.period_m * kPeriodRatio));

  const auto weight = static_cast<double>(weight_);
  for (const Tile& tile : tiles_) {
    double lowest = 0.0;
    double highest = 0.0;
    for (std::size_t level = 0; level < tile.noise.level_count(); ++level) {
      const auto& values = tile.noise.level(level).values;
      const auto [low, high] = std::minmax_element(values.begin(), values.end());
      lowest = std::min(lowest, static_cast<double>(*low));
      highest = std::max(highest, static_cast<double>(*high));
    }
    lowest_ += weight * lowest;
    highest_ += weight * highest;
  }
}

CarriedNoiseSpec CarriedNoise::band(double shortest_m, double longest_m, std::uint64_t seed, bool has_two_tiles) {
  constexpr double kMaxWaves = 8.0;
  constexpr double kSamplesAWave = 4.5;
  const double period_m = kMaxWaves * longest_m;
  // The second tile is larger, and has the same number of samples.
  const double largest_m = has_two_tiles ? kPeriodRatio * period_m : period_m;
  const auto samples = static_cast<std::size_t>(std::ceil(kSamplesAWave * largest_m / shortest_m));
  return {.period_m = period_m,
          .samples = std::bit_ceil(samples),
          .beta = 1.0,
          .has_two_tiles = has_two_tiles,
          .shortest_m = shortest_m,
          .longest_m = longest_m,
          .seed = seed};
}

CarriedPlaces CarriedNoise::places(std::span<const float> x_m, std::span<const float> z_m) const {
  CarriedPlaces places;
  add_phases(x_m, z_m, turn_cos_, turn_sin_, tiles_.front().period_m, places.first_x, places.first_z);
  if (tiles_.size() > 1) {
    add_phases(x_m, z_m, kTurnCos, kTurnSin, tiles_.back().period_m, places.second_x, places.second_z);
  }
  return places;
}

void CarriedNoise::shift(double toward_x_m_s, double toward_z_m_s, double dt_s) noexcept {
  const double speed_m_s = std::sqrt(toward_x_m_s * toward_x_m_s + toward_z_m_s * toward_z_m_s);
  double east_m_s = turn_cos_ * toward_x_m_s - turn_sin_ * toward_z_m_s;
  double south_m_s = turn_sin_ * toward_x_m_s + turn_cos_ * toward_z_m_s;
  for (Tile& tile : tiles_) {
    operators::ShiftJob{.wind_east_m_s = east_m_s,
                        .wind_south_m_s = south_m_s,
                        .dt_s = dt_s,
                        .period_m = tile.period_m,
                        .offset = &tile.offset}
        .run();
    tile.band = tile.noise.pick(speed_m_s, 1.0 / dt_s, tile.period_m);
    east_m_s = kTurnCos * toward_x_m_s - kTurnSin * toward_z_m_s;
    south_m_s = kTurnSin * toward_x_m_s + kTurnCos * toward_z_m_s;
  }
}

void CarriedNoise::sample(const CarriedPlaces& places, SimdRow row, std::span<float> out, float scale, float bias,
                          float low, float high, std::size_t first) const noexcept {
  // A tile is one layer, and two while the wind is so strong that its finest waves fade out.
  std::array<operators::NoiseLayer, operators::SampleJob::kMaxLayers> layers;
  std::size_t count = 0;
  for (const Tile& tile : tiles_) {
    const bool is_first = &tile == tiles_.data();
    operators::NoiseLayer layer{
        .tile = &tile.noise.level(tile.band.level),
        .place_x = std::span(is_first ? places.first_x : places.second_x).subspan(first, out.size()),
        .place_z = std::span(is_first ? places.first_z : places.second_z).subspan(first, out.size()),
        .offset = tile.offset.phase(),
        .weight = weight_ * (1.0F - tile.band.weight)};
    layers[count++] = layer;
    if (tile.band.weight == 0.0F) continue;
    layer.tile = &tile.noise.level(tile.band.next);
    layer.weight = weight_ * tile.band.weight;
    layers[count++] = layer;
  }
  operators::SampleJob{.layers = std::span(layers).first(count),
                       .scale = scale,
                       .bias = bias,
                       .low = low,
                       .high = high,
                       .row = row,
                       .out = out}
      .run();
}

double CarriedNoise::largest_change(double speed_m_s, double step_m_s, double dt_s) const noexcept {
  double change = 0.0;
  for (const Tile& tile : tiles_) {
    // The pick moves to the next level while the speed doubles, from where the waves of level 0 are too fine.
    double of_tile = 0.0;
    constexpr int kSpeeds = 64;
    for (int i = 1; i <= kSpeeds; ++i) {
      const double speed = speed_m_s * i / kSpeeds;
      const std::size_t level = tile.noise.pick(speed * (kSpeeds - 1) / kSpeeds, 1.0 / dt_s, tile.period_m).level;
      of_tile = std::max(of_tile, tile.steepest_per_m[level] * speed * dt_s);
    }
    // The pick goes on by a level while the speed doubles, and begins where the waves of level 0 are too fine.
    const double begins_m_s = tile.period_m / (4.0 * dt_s * tile.noise.end_cycles(0));
    const double levels =
        std::min(std::log2(1.0 + step_m_s / begins_m_s), static_cast<double>(tile.noise.level_count() - 1));
    of_tile += levels * tile.largest_octave;
    change += static_cast<double>(weight_) * of_tile;
  }
  return std::min(change, highest_ - lowest_);
}

}  // namespace yuragi::scenes
