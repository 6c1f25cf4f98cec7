#include "engine/wind/gust_noise.hpp"

#include <cmath>
#include <numbers>
#include <utility>

#include "engine/math/philox.hpp"
#include "engine/noise/spectral_noise.hpp"
#include "engine/noise/turning_noise.hpp"

namespace yuragi {
namespace {

constexpr double kTurn_rad = 1.0;  // of the second tile
/// The way repeats after so many tiles: one octave above its shortest waves the tiles begin.
constexpr double kTilesPerWay = static_cast<double>(std::size_t{1} << GustNoise::kWayOctaves);
constexpr std::size_t kWaySamples = std::size_t{4} << GustNoise::kWayOctaves;
constexpr double kBeta = 5.0 / 3.0;

/// An octave weaker than this moves nothing, and is not read.
constexpr float kNothing_m_s = 1e-4F;

/// What reading between samples leaves of an octave's standard deviation, measured at places at random.
template <class Tile, class PlaceAt>
double read_deviation(const Tile& tile, PlaceAt place_at) {
  constexpr std::uint64_t kPlaces = 1 << 14U;
  const RandomStream random(1, stream_id("gust noise: where an octave is measured"));
  double squares = 0.0;
  for (std::uint64_t i = 0; i < kPlaces; ++i) {
    const auto [x, z] = random.uniform_pair(i);
    const auto value = static_cast<double>(read_noise(tile, place_at(x, z)));
    squares += value * value;
  }
  return std::sqrt(squares / static_cast<double>(kPlaces));
}

std::uint32_t phase_of(double part) noexcept {
  return static_cast<std::uint32_t>(part * 4294967296.0);
}

/// `along` and `across` of a unit vector, in the world.
WindVector turned(WindVector unit, double along, double across) noexcept {
  return {along * unit.u_m_s - across * unit.v_m_s, along * unit.v_m_s + across * unit.u_m_s};
}

void scale_to_unit_reading(NoiseTile2& tile) {
  const double deviation = read_deviation(tile, [](double x, double z) {
    return TorusPhase{phase_of(x), phase_of(z)};
  });
  for (float& value : tile.values) value = static_cast<float>(static_cast<double>(value) / deviation);
}

NoiseSpec tile_octave(std::size_t octave, std::size_t samples, std::uint64_t seed) {
  const double cycles = std::ldexp(1.0, static_cast<int>(octave));
  return {.size = samples, .beta = kBeta, .seed = seed, .from_cycles = cycles, .to_cycles = 2.0 * cycles};
}

NoiseTile1 way_octave(std::size_t octave, std::uint64_t seed) {
  const double cycles = std::ldexp(1.0, static_cast<int>(octave));
  NoiseTile1 tile =
      make_noise_1d(
          {.size = kWaySamples, .beta = kBeta, .seed = seed, .from_cycles = cycles, .to_cycles = 2.0 * cycles})
          .value();
  const double deviation = read_deviation(tile, [](double x, double) { return phase_of(x); });
  for (float& value : tile.values) value = static_cast<float>(static_cast<double>(value) / deviation);
  return tile;
}

}  // namespace

GustNoise::GustNoise(const GustNoiseSettings& settings)
    : periods_m_{settings.period_m, std::numbers::phi * settings.period_m},
      evolves_(settings.evolves),
      along_(make_octaves(settings, settings.seed ^ stream_id("gusts along the wind"))),
      across_(make_octaves(settings, settings.seed ^ stream_id("gusts across the wind"))) {
  // The octaves of the way, then those of the tiles. The first tile's and the second's overlap, and share.
  constexpr double kTurn = 2.0 * std::numbers::pi;
  std::size_t next = 0;
  for (std::size_t which = 0; which < 2; ++which) {
    for (std::size_t octave = 0; octave < kWayOctaves; ++octave) {
      const double from = kTurn / (kTilesPerWay * periods_m_[which]) * std::ldexp(1.0, static_cast<int>(octave));
      octaves_[next++] = {from, 2.0 * from, 0.5};
    }
  }
  for (std::size_t which = 0; which < 2; ++which) {
    for (std::size_t octave = 0; octave < kTileOctaves; ++octave) {
      const double from = kTurn / periods_m_[which] * std::ldexp(1.0, static_cast<int>(octave));
      octaves_[next++] = {from, 2.0 * from, 0.5};
    }
  }
}

GustNoise::Octaves GustNoise::make_octaves(const GustNoiseSettings& settings, std::uint64_t seed) {
  Octaves component;
  for (std::size_t which = 0; which < 2; ++which) {
    for (std::size_t octave = 0; octave < kTileOctaves; ++octave) {
      const NoiseSpec spec = tile_octave(octave, settings.samples, seed + 100 * which + octave);
      if (settings.evolves) {
        TurningNoise2 noise = make_turning_noise_2d(spec).value();
        scale_to_unit_reading(noise.quarter);
        component.quarters[which].push_back(std::move(noise.quarter));
        component.tiles[which].push_back(std::move(noise.first));
      } else {
        component.tiles[which].push_back(make_noise_2d(spec).value());
      }
      scale_to_unit_reading(component.tiles[which].back());
    }
    for (std::size_t octave = 0; octave < kWayOctaves; ++octave) {
      component.ways[which].push_back(way_octave(octave, seed + 100 * which + octave));
    }
  }
  return component;
}

GustNoise::Carried GustNoise::begin(std::uint64_t seed) const noexcept {
  const RandomStream random(seed, stream_id("where gusts begin"));
  const auto [east, south] = random.uniform_pair(0);
  const auto [first, second] = random.uniform_pair(1);
  Carried carried;
  carried.first.x.add(east * periods_m_[0], periods_m_[0]);
  carried.first.z.add(south * periods_m_[0], periods_m_[0]);
  carried.second.x.add(first * periods_m_[1], periods_m_[1]);
  carried.second.z.add(second * periods_m_[1], periods_m_[1]);
  carried.way_first.add(first * kTilesPerWay * periods_m_[0], kTilesPerWay * periods_m_[0]);
  carried.way_second.add(south * kTilesPerWay * periods_m_[1], kTilesPerWay * periods_m_[1]);
  return carried;
}

void GustNoise::carry(Carried& carried, double east_m_s, double south_m_s, double dt_s,
                      double turnover_m23_s) const noexcept {
  const double c = std::cos(kTurn_rad);
  const double s = std::sin(kTurn_rad);
  carried.first.x.add(east_m_s * dt_s, periods_m_[0]);
  carried.first.z.add(south_m_s * dt_s, periods_m_[0]);
  carried.second.x.add((c * east_m_s + s * south_m_s) * dt_s, periods_m_[1]);
  carried.second.z.add((c * south_m_s - s * east_m_s) * dt_s, periods_m_[1]);
  const double way_m = std::hypot(east_m_s, south_m_s) * dt_s;
  carried.way_first.add(way_m, kTilesPerWay * periods_m_[0]);
  carried.way_second.add(way_m, kTilesPerWay * periods_m_[1]);

  if (!evolves_ || turnover_m23_s == 0.0) return;
  constexpr double kFullTurn_rad = 2.0 * std::numbers::pi;
  for (std::size_t i = 0; i < 2 * kTileOctaves; ++i) {
    const double middle_rad_m = std::numbers::sqrt2 * octaves_[2 * kWayOctaves + i].from_rad_m;
    TorusTravel& turn = carried.turned.turns[i];
    turn.add(turnover_m23_s * std::cbrt(middle_rad_m * middle_rad_m) * dt_s, kFullTurn_rad);
    const double angle_rad = kFullTurn_rad * 0x1p-32 * static_cast<double>(turn.phase());
    carried.turned.cosine[i] = static_cast<float>(std::cos(angle_rad));
    carried.turned.sine[i] = static_cast<float>(std::sin(angle_rad));
  }
}

TorusPhase GustNoise::place_on(std::size_t which, double east_m, double south_m) const noexcept {
  if (which == 0) return {torus_phase(east_m, periods_m_[0]), torus_phase(south_m, periods_m_[0])};
  const double c = std::cos(kTurn_rad);
  const double s = std::sin(kTurn_rad);
  return {torus_phase(c * east_m + s * south_m, periods_m_[1]), torus_phase(c * south_m - s * east_m, periods_m_[1])};
}

GustNoise::Values GustNoise::at(const Carried& carried, double east_m, double south_m) const noexcept {
  // A field that has moved by X is read at x - X.
  const TorusPhase first = place_on(0, east_m, south_m) - carried.first.phase();
  const TorusPhase second = place_on(1, east_m, south_m) - carried.second.phase();
  return {read(along_, first, second, carried), read(across_, first, second, carried)};
}

WindVector GustNoise::everywhere(const Moment& moment) const noexcept {
  double along = 0.0;
  double across = 0.0;
  for (std::size_t which = 0; which < 2; ++which) {
    const std::uint32_t phase = which == 0 ? moment.carried.way_first.phase() : moment.carried.way_second.phase();
    for (std::size_t i = 0; i < kWayOctaves; ++i) {
      const std::size_t octave = which * kWayOctaves + i;
      along += static_cast<double>(moment.along_m_s[octave] * read_noise(along_.ways[which][i], phase));
      across += static_cast<double>(moment.across_m_s[octave] * read_noise(across_.ways[which][i], phase));
    }
  }
  return turned(moment.ahead, along, across);
}

std::size_t GustNoise::layers(const Moment& moment, Component component,
                              std::span<Layer, kMaxLayers> out) const noexcept {
  const bool is_along = component == Component::kAlong;
  const Octaves& octaves = is_along ? along_ : across_;
  const auto& weights_m_s = is_along ? moment.along_m_s : moment.across_m_s;
  const std::array<TorusPhase, 2> offsets = {moment.carried.first.phase(), moment.carried.second.phase()};
  std::size_t count = 0;
  for (std::size_t which = 0; which < 2; ++which) {
    for (std::size_t i = 0; i < kTileOctaves; ++i) {
      const float weight_m_s = weights_m_s[2 * kWayOctaves + which * kTileOctaves + i];
      if (weight_m_s < kNothing_m_s) continue;
      const std::size_t turn = which * kTileOctaves + i;
      out[count++] = {&octaves.tiles[which][i], which, offsets[which], moment.carried.turned.cosine[turn] * weight_m_s};
      if (!evolves_) continue;
      out[count++] = {&octaves.quarters[which][i], which, offsets[which],
                      moment.carried.turned.sine[turn] * weight_m_s};
    }
  }
  return count;
}

WindVector GustNoise::local(const Moment& moment, double east_m, double south_m) const noexcept {
  const std::array<TorusPhase, 2> places = {place_on(0, east_m, south_m), place_on(1, east_m, south_m)};
  const auto sum_of = [&](Component component) {
    std::array<Layer, kMaxLayers> all;
    const std::size_t count = layers(moment, component, all);
    float sum = 0.0F;
    for (const Layer& layer : std::span(all).first(count)) {
      sum += layer.weight_m_s * read_noise(*layer.tile, places[layer.which] - layer.offset);
    }
    return static_cast<double>(sum);
  };
  return turned(moment.ahead, sum_of(Component::kAlong), sum_of(Component::kAcross));
}

std::array<float, GustNoise::kOctaves> GustNoise::read(const Octaves& component, TorusPhase first, TorusPhase second,
                                                       const Carried& carried) const noexcept {
  std::array<float, kOctaves> values{};
  std::size_t next = 0;
  for (const NoiseTile1& way : component.ways[0]) values[next++] = read_noise(way, carried.way_first.phase());
  for (const NoiseTile1& way : component.ways[1]) values[next++] = read_noise(way, carried.way_second.phase());
  for (std::size_t i = 0; i < kTileOctaves; ++i) values[next++] = read_tile(component, 0, i, first, carried.turned);
  for (std::size_t i = 0; i < kTileOctaves; ++i) values[next++] = read_tile(component, 1, i, second, carried.turned);
  return values;
}

/// An octave of a tile at a place, its eddies as far turned as they are.
float GustNoise::read_tile(const Octaves& component, std::size_t which, std::size_t octave, TorusPhase place,
                           const Turned& turned) noexcept {
  const float first = read_noise(component.tiles[which][octave], place);
  if (component.quarters[which].empty()) return first;
  const std::size_t turn = which * kTileOctaves + octave;
  return turned.cosine[turn] * first + turned.sine[turn] * read_noise(component.quarters[which][octave], place);
}

double eddy_turnover_m23_s(double sigma_m_s, double length_m) noexcept {
  constexpr double kDissipation = 0.88;
  return kDissipation * sigma_m_s / std::cbrt(length_m);
}

}  // namespace yuragi
