#include "engine/wind/turbulence/gust_noise.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <numbers>
#include <span>

#include "engine/math/philox.hpp"
#include "engine/math/portable.hpp"
#include "engine/noise/spectral_noise.hpp"
#include "engine/noise/torus_read.hpp"
#include "engine/noise/unit_reading.hpp"
#include "engine/noise/vector_noise.hpp"

namespace yuragi::wind::turbulence {
namespace {

/// The long tile, the middle one and the short one of a chain: their periods, in those of the middle one, and the
/// cycles an edge of their longest waves. The turns of the six: they differ by 0.2 rad or more, modulo quarter turns.
constexpr std::array kPeriods = {8.0, 1.0, 0.125};
constexpr std::array kFirstCycles = {1.0, 2.0, 16.0};
constexpr std::array<std::size_t, 3> kFirstOctave = {0, GustNoise::kLongOctaves,
                                                     GustNoise::kTileOctaves - GustNoise::kShortOctaves};
constexpr std::array kTurns_rad = {2.0, 0.0, 0.7, 3.0, 1.0, 1.2};

/// The way repeats after this many middle tiles: the long tiles begin one octave above its shortest waves.
constexpr double kTilesPerWay = 8.0 * static_cast<double>(std::size_t{1} << GustNoise::kWayOctaves);
constexpr std::size_t kWaySamples = std::size_t{16} << GustNoise::kWayOctaves;
constexpr double kBeta = 5.0 / 3.0;

/// The envelope's waves, in cycles of the long tile: 100 to 400 m.
constexpr double kStrengthFromCycles = 5.12;
constexpr double kStrengthToCycles = 20.48;
constexpr std::size_t kStrengthSamples = 128;

/// A weaker octave is not read.
constexpr float kNothing_m_s = 1e-4F;

/// The mean square of the rise of a vector's components along themselves from sample to sample. Between two rows, one
/// of which rises by a and the other by b, it is (a^2 + a b + b^2) / 3.
double rise_variance(const noise::VectorTile2& tile) {
  const std::size_t size = tile.x.size;
  const std::size_t last = size - 1;  // a power of two less one
  double squares = 0.0;
  for (std::size_t row = 0; row < size; ++row) {
    const std::size_t next_row = (row + 1) & last;
    for (std::size_t i = 0; i < size; ++i) {
      const std::size_t next = (i + 1) & last;
      const auto add = [&squares](float rise, float beside) {
        squares += static_cast<double>(rise * (2.0F * rise + beside)) / 3.0;
      };
      add(tile.x.at(next, row) - tile.x.at(i, row), tile.x.at(next, next_row) - tile.x.at(i, next_row));
      add(tile.z.at(row, next) - tile.z.at(row, i), tile.z.at(next_row, next) - tile.z.at(next_row, i));
    }
  }
  return squares / static_cast<double>(2 * size * size);
}

/// `along` and `across` of a unit vector, in the world.
Vector turned(Vector unit, double along, double across) noexcept {
  return {along * unit.u_m_s - across * unit.v_m_s, along * unit.v_m_s + across * unit.u_m_s};
}

/// An octave of a chain's tiles. Tiles are as large as needed: 16 samples for the longest wave if that is at most half
/// the largest edge, otherwise 8.
noise::Spec tile_octave(std::size_t octave, std::size_t samples, std::uint64_t seed) {
  const std::size_t tile = GustNoise::torus_of(octave);
  const double cycles = std::ldexp(kFirstCycles[tile], static_cast<int>(octave - kFirstOctave[tile]));
  constexpr std::size_t kMinSamples = 64;
  const std::size_t a_wave = samples / 64;
  const auto fewest = a_wave * static_cast<std::size_t>(cycles);
  return {.size = std::max(kMinSamples, std::min(2 * fewest, std::max(samples / 2, fewest))),
          .beta = kBeta,
          .seed = seed,
          .from_cycles = cycles,
          .to_cycles = 2.0 * cycles};
}

noise::Tile1 way_octave(std::size_t octave, std::uint64_t seed) {
  const double cycles = std::ldexp(1.0, static_cast<int>(octave));
  noise::Tile1 tile =
      noise::make_noise_1d(
          {.size = kWaySamples, .beta = kBeta, .seed = seed, .from_cycles = cycles, .to_cycles = 2.0 * cycles})
          .value();
  noise::scale_to_unit_reading(tile);
  return tile;
}

noise::Tile2 make_strength(std::uint64_t seed) {
  noise::Tile2 tile = noise::make_noise_2d({.size = kStrengthSamples,
                                            .beta = kBeta,
                                            .seed = seed ^ math::stream_id("how strong gusts are"),
                                            .from_cycles = kStrengthFromCycles,
                                            .to_cycles = kStrengthToCycles})
                          .value();
  noise::scale_to_unit_reading(tile);
  return tile;
}

}  // namespace

GustNoise::GustNoise(const GustNoiseSettings& settings)
    : settings_(settings),
      ways_along_(make_ways(settings.seed ^ math::stream_id("gusts along the wind"))),
      ways_across_(make_ways(settings.seed ^ math::stream_id("gusts across the wind"))),
      tiles_(make_tiles(settings)),
      strength_(make_strength(settings.seed)) {
  constexpr double kTurn = 2.0 * std::numbers::pi;
  for (std::size_t chain = 0; chain < 2; ++chain) {
    const double period_m = chain == 0 ? settings.period_m : std::numbers::phi * settings.period_m;
    way_periods_m_[chain] = kTilesPerWay * period_m;
    for (std::size_t i = 0; i < kPeriods.size(); ++i) {
      const std::size_t torus = kPeriods.size() * chain + i;
      tori_[torus] = {kPeriods[i] * period_m, std::cos(kTurns_rad[torus]), std::sin(kTurns_rad[torus])};
    }
    // Each begins at the end of the one before: at twice the wavenumber. The chains overlap, and share the power.
    double from_rad_m = kTurn / way_periods_m_[chain];
    const auto next = [&from_rad_m] {
      const Octave octave{from_rad_m, 2.0 * from_rad_m, 0.5};
      from_rad_m = octave.to_rad_m;
      return octave;
    };
    for (std::size_t i = 0; i < kWayOctaves; ++i) octaves_[chain * kWayOctaves + i] = next();
    for (std::size_t i = 0; i < kTileOctaves; ++i) {
      const std::size_t tile_octave = chain * kTileOctaves + i;
      const Octave& octave = octaves_[2 * kWayOctaves + tile_octave] = next();
      const double middle_rad_m = std::numbers::sqrt2 * octave.from_rad_m;
      turn_rates_m_23_[tile_octave] = math::cube_root(middle_rad_m * middle_rad_m);
      if (i < kLongOctaves) continue;  // they make no fronts
      const double sample = sample_m(tile_octave);
      slope_variances_m_2_[tile_octave] =
          static_cast<float>(rise_variance(tiles_[tile_octave].first) / (sample * sample));
    }
  }
}

GustNoise::Ways GustNoise::make_ways(std::uint64_t seed) {
  Ways ways;
  for (std::size_t i = 0; i < ways.size(); ++i) {
    ways[i] = way_octave(i % kWayOctaves, seed + 100 * (i / kWayOctaves) + i % kWayOctaves);
  }
  return ways;
}

GustNoise::Tiles GustNoise::make_tiles(const GustNoiseSettings& settings) {
  Tiles tiles;
  noise::VectorNoiseMaker maker;
  const std::uint64_t seed = settings.seed ^ math::stream_id("gusts of the tiles");
  for (std::size_t i = 0; i < tiles.size(); ++i) {
    const std::size_t chain = i / kTileOctaves;
    const std::size_t octave = i % kTileOctaves;
    tiles[i] = maker.make(tile_octave(octave, settings.samples, seed + 100 * chain + octave), settings.evolves).value();
    for (noise::VectorTile2* tile : {&tiles[i].first, &tiles[i].quarter}) {
      if (tile->x.size == 0) continue;
      noise::scale_to_unit_reading(tile->x);
      noise::scale_to_unit_reading(tile->z);
    }
  }
  return tiles;
}

std::array<std::array<float, 2>, GustNoise::kTori> GustNoise::on_axes(Vector unit) const noexcept {
  std::array<std::array<float, 2>, kTori> axes{};
  for (std::size_t torus = 0; torus < kTori; ++torus) {
    const auto [x, z] = tori_[torus].turned(unit.u_m_s, -unit.v_m_s);
    axes[torus] = {static_cast<float>(x), static_cast<float>(z)};
  }
  return axes;
}

GustNoise::Carried GustNoise::begin(std::uint64_t seed) const noexcept {
  const math::RandomStream random(seed, math::stream_id("where gusts begin"));
  Carried carried;
  for (std::size_t i = 0; i < kTori; ++i) {
    const auto [x, z] = random.uniform_pair(i);
    carried.tiles[i].x.add(x * tori_[i].period_m, tori_[i].period_m);
    carried.tiles[i].z.add(z * tori_[i].period_m, tori_[i].period_m);
  }
  const auto [first, second] = random.uniform_pair(kTori);
  carried.way_first.add(first * way_periods_m_[0], way_periods_m_[0]);
  carried.way_second.add(second * way_periods_m_[1], way_periods_m_[1]);
  return carried;
}

void GustNoise::carry(Carried& carried, double east_m_s, double south_m_s, double dt_s,
                      double turnover_m23_s) const noexcept {
  for (std::size_t i = 0; i < kTori; ++i) {
    const auto [x_m, z_m] = tori_[i].turned(east_m_s * dt_s, south_m_s * dt_s);
    carried.tiles[i].x.add(x_m, tori_[i].period_m);
    carried.tiles[i].z.add(z_m, tori_[i].period_m);
  }
  const double way_m = math::length(east_m_s, south_m_s) * dt_s;
  carried.way_first.add(way_m, way_periods_m_[0]);
  carried.way_second.add(way_m, way_periods_m_[1]);

  if (!settings_.evolves || turnover_m23_s == 0.0) return;
  constexpr double kFullTurn_rad = 2.0 * std::numbers::pi;
  for (std::size_t i = 0; i < 2 * kTileOctaves; ++i) {
    noise::TorusTravel& turn = carried.eddies.turns[i];
    turn.add(turnover_m23_s * turn_rates_m_23_[i] * dt_s, kFullTurn_rad);
    const double angle_rad = kFullTurn_rad * 0x1p-32 * static_cast<double>(turn.phase());
    carried.eddies.cosine[i] = static_cast<float>(std::cos(angle_rad));
    carried.eddies.sine[i] = static_cast<float>(std::sin(angle_rad));
  }
}

noise::TorusPhase GustNoise::place_on(std::size_t torus, double east_m, double south_m) const noexcept {
  const auto [x_m, z_m] = tori_[torus].turned(east_m, south_m);
  return {noise::torus_phase(x_m, tori_[torus].period_m), noise::torus_phase(z_m, tori_[torus].period_m)};
}

/// Octave by octave: a field that has moved by X is read at x - X, with its eddies turned by their angle.
GustNoise::Values GustNoise::at(const Carried& carried, double east_m, double south_m, Vector ahead) const noexcept {
  Values values{};
  for (std::size_t i = 0; i < 2 * kWayOctaves; ++i) {
    const std::uint32_t phase = (i < kWayOctaves ? carried.way_first : carried.way_second).phase();
    values.along[i] = noise::read_noise(ways_along_[i], phase);
    values.across[i] = noise::read_noise(ways_across_[i], phase);
  }
  Moment moment;
  moment.carried = carried;
  moment.ahead = ahead;
  moment.along_m_s.fill(1.0F);
  moment.across_m_s.fill(1.0F);
  std::array<Layer, kMaxLayers> all;
  const std::size_t count = layers(moment, all);
  for (const Layer& layer : std::span(all).first(count)) {
    const noise::VectorReading gust = read(layer, place_on(torus_of(layer.octave), east_m, south_m));
    values.along[kFirstTileOctave + layer.octave] = gust.along;
    values.across[kFirstTileOctave + layer.octave] = gust.across;
  }
  return values;
}

noise::VectorReading GustNoise::read(const Layer& layer, noise::TorusPhase place) noexcept {
  const auto log2_size = static_cast<unsigned>(std::countr_zero(layer.tile->x.size));
  const noise::TorusPhase there = place - layer.offset;
  const noise::TorusCorners at = noise::torus_corners(log2_size, there.x, there.z);
  const noise::VectorTiles tiles = {.x = layer.tile->x.values.data(),
                                    .z = layer.tile->z.values.data(),
                                    .quarter_x = layer.quarter == nullptr ? nullptr : layer.quarter->x.values.data(),
                                    .quarter_z = layer.quarter == nullptr ? nullptr : layer.quarter->z.values.data(),
                                    .cosine = layer.cosine,
                                    .sine = layer.sine};
  return noise::read_vector(tiles, at, layer.ahead_x, layer.ahead_z);
}

Vector GustNoise::everywhere(const Moment& moment) const noexcept {
  double along = 0.0;
  double across = 0.0;
  for (std::size_t i = 0; i < 2 * kWayOctaves; ++i) {
    const noise::TorusTravel& way = i < kWayOctaves ? moment.carried.way_first : moment.carried.way_second;
    along += static_cast<double>(moment.along_m_s[i] * noise::read_noise(ways_along_[i], way.phase()));
    across += static_cast<double>(moment.across_m_s[i] * noise::read_noise(ways_across_[i], way.phase()));
  }
  return turned(moment.ahead, along, across);
}

/// From the longest waves to the shortest: the second chain's octave is longer than the first's.
std::size_t GustNoise::layers(const Moment& moment, std::span<Layer, kMaxLayers> out) const noexcept {
  const auto ahead = on_axes(moment.ahead);
  const Carried& carried = moment.carried;
  const float even = 1.0F / std::sqrt(1.0F + moment.fronts * moment.fronts);
  float fall_variance = 0.0F;  // of the octaves so far, 1/s^2
  std::size_t count = 0;
  for (std::size_t place = 0; place < 2 * kTileOctaves; ++place) {
    const std::size_t i = place / 2 + (place % 2 == 0 ? kTileOctaves : 0);
    const float along_m_s = moment.along_m_s[kFirstTileOctave + i];
    const float across_m_s = moment.across_m_s[kFirstTileOctave + i];
    if (along_m_s < kNothing_m_s && across_m_s < kNothing_m_s) continue;
    const std::size_t torus = torus_of(i);
    Layer& layer = out[count++];
    layer = {.tile = &tiles_[i].first,
             .quarter = settings_.evolves ? &tiles_[i].quarter : nullptr,
             .cosine = carried.eddies.cosine[i],
             .sine = carried.eddies.sine[i],
             .octave = i,
             .offset = carried.tiles[torus].phase(),
             .ahead_x = ahead[torus][0],
             .ahead_z = ahead[torus][1],
             .along_m_s = along_m_s,
             .across_m_s = across_m_s};
    if (moment.fronts == 0.0F || i % kTileOctaves < kLongOctaves) continue;
    layer.samples_per_m = static_cast<float>(1.0 / sample_m(i));
    if (fall_variance > 0.0F) {
      layer.strength = even;
      layer.strength_per_fall_s = even * moment.fronts / std::sqrt(fall_variance);
    }
    fall_variance += along_m_s * along_m_s * slope_variances_m_2_[i];
  }
  return count;
}

Vector GustNoise::local(const Moment& moment, double east_m, double south_m) const noexcept {
  std::array<noise::TorusPhase, kTori> places;
  for (std::size_t torus = 0; torus < kTori; ++torus) places[torus] = place_on(torus, east_m, south_m);
  std::array<Layer, kMaxLayers> all;
  const std::size_t count = layers(moment, all);
  float along = 0.0F;
  float across = 0.0F;
  float fall = 0.0F;
  for (const Layer& layer : std::span(all).first(count)) {
    const noise::VectorReading gust = read(layer, places[torus_of(layer.octave)]);
    const float strength = layer.strength + layer.strength_per_fall_s * fall;
    along += strength * (layer.along_m_s * gust.along);
    across += strength * (layer.across_m_s * gust.across);
    fall -= layer.samples_per_m * (layer.along_m_s * gust.rise);
  }
  const float strength = envelope(moment, east_m, south_m);
  return turned(moment.ahead, static_cast<double>(strength * along), static_cast<double>(strength * across));
}

float GustNoise::envelope(const Moment& moment, double east_m, double south_m) const noexcept {
  const float g = moment.gustiness;
  if (g == 0.0F) return 1.0F;
  return std::exp(g * noise::read_noise(strength_, place_on(0, east_m, south_m) - moment.carried.tiles[0].phase()) -
                  g * g);
}

double eddy_turnover_m23_s(double sigma_m_s, double length_m) noexcept {
  constexpr double kDissipation = 0.88;
  return kDissipation * sigma_m_s / math::cube_root(length_m);
}

}  // namespace yuragi::wind::turbulence
