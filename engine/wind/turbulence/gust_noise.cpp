#include "engine/wind/turbulence/gust_noise.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <numbers>
#include <span>
#include <utility>

#include "engine/math/philox.hpp"
#include "engine/noise/spectral_noise.hpp"
#include "engine/noise/torus_read.hpp"
#include "engine/noise/turning_noise.hpp"
#include "engine/noise/unit_reading.hpp"

namespace yuragi::wind::turbulence {
namespace {

/// The long tile, the middle one and the short one of a chain: their periods, in middle ones, and the cycles an edge of
/// their longest waves. By what angle each of the six is turned: they differ by 0.2 rad or more, quarter turns aside.
constexpr std::array kPeriods = {8.0, 1.0, 0.125};
constexpr std::array kFirstCycles = {1.0, 2.0, 16.0};
constexpr std::array<std::size_t, 3> kFirstOctave = {0, GustNoise::kLongOctaves,
                                                     GustNoise::kTileOctaves - GustNoise::kShortOctaves};
constexpr std::array kTurns_rad = {2.0, 0.0, 0.7, 3.0, 1.0, 1.2};

/// The way repeats after so many middle tiles: one octave above its shortest waves the long tiles begin.
constexpr double kTilesPerWay = 8.0 * static_cast<double>(std::size_t{1} << GustNoise::kWayOctaves);
constexpr std::size_t kWaySamples = std::size_t{16} << GustNoise::kWayOctaves;
constexpr double kBeta = 5.0 / 3.0;

/// The envelope's waves, in cycles of the long tile: 100 to 400 m.
constexpr double kStrengthFromCycles = 5.12;
constexpr double kStrengthToCycles = 20.48;
constexpr std::size_t kStrengthSamples = 128;

/// An octave weaker than this is not read.
constexpr float kNothing_m_s = 1e-4F;

/// `along` and `across` of a unit vector, in the world.
WindVector turned(WindVector unit, double along, double across) noexcept {
  return {along * unit.u_m_s - across * unit.v_m_s, along * unit.v_m_s + across * unit.u_m_s};
}

/// An octave of a chain's tiles. Tiles are as large as their waves need: 16 samples for the longest where that is no
/// more than half the largest edge, else 8.
noise::NoiseSpec tile_octave(std::size_t octave, std::size_t samples, std::uint64_t seed) {
  const std::size_t tile = GustNoise::torus_of(octave);
  const double cycles = std::ldexp(kFirstCycles[tile], static_cast<int>(octave - kFirstOctave[tile]));
  constexpr std::size_t kFewestSamples = 64;
  const std::size_t a_wave = samples / 64;
  const auto fewest = a_wave * static_cast<std::size_t>(cycles);
  return {.size = std::max(kFewestSamples, std::min(2 * fewest, std::max(samples / 2, fewest))),
          .beta = kBeta,
          .seed = seed,
          .from_cycles = cycles,
          .to_cycles = 2.0 * cycles};
}

noise::NoiseTile1 way_octave(std::size_t octave, std::uint64_t seed) {
  const double cycles = std::ldexp(1.0, static_cast<int>(octave));
  noise::NoiseTile1 tile =
      noise::make_noise_1d(
          {.size = kWaySamples, .beta = kBeta, .seed = seed, .from_cycles = cycles, .to_cycles = 2.0 * cycles})
          .value();
  noise::scale_to_unit_reading(tile);
  return tile;
}

noise::NoiseTile2 make_strength(std::uint64_t seed) {
  noise::NoiseTile2 tile = noise::make_noise_2d({.size = kStrengthSamples,
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
    : evolves_(settings.evolves),
      along_(make_octaves(settings, settings.seed ^ math::stream_id("gusts along the wind"))),
      across_(make_octaves(settings, settings.seed ^ math::stream_id("gusts across the wind"))),
      strength_(make_strength(settings.seed)) {
  constexpr double kTurn = 2.0 * std::numbers::pi;
  for (std::size_t chain = 0; chain < 2; ++chain) {
    const double period_m = chain == 0 ? settings.period_m : std::numbers::phi * settings.period_m;
    way_periods_m_[chain] = kTilesPerWay * period_m;
    for (std::size_t i = 0; i < kPeriods.size(); ++i) {
      const std::size_t torus = kPeriods.size() * chain + i;
      tori_[torus] = {kPeriods[i] * period_m, std::cos(kTurns_rad[torus]), std::sin(kTurns_rad[torus])};
    }
    // Each begins where the one before it ends: twice as many waves to the metre. The chains' overlap, and share.
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
      turn_rates_m_23_[tile_octave] = std::cbrt(middle_rad_m * middle_rad_m);
    }
  }
}

GustNoise::Octaves GustNoise::make_octaves(const GustNoiseSettings& settings, std::uint64_t seed) {
  Octaves component;
  noise::TurningNoiseMaker turning;
  for (std::size_t chain = 0; chain < 2; ++chain) {
    const std::uint64_t chain_seed = seed + 100 * chain;
    for (std::size_t i = 0; i < kTileOctaves; ++i) {
      const noise::NoiseSpec spec = tile_octave(i, settings.samples, chain_seed + i);
      noise::NoiseTile2& tile = component.tiles[chain * kTileOctaves + i];
      if (settings.evolves) {
        noise::TurningNoise2 noise = turning.make(spec).value();
        noise::NoiseTile2& quarter = component.quarters[chain * kTileOctaves + i];
        tile = std::move(noise.first);
        quarter = std::move(noise.quarter);
        noise::scale_to_unit_reading(quarter);
      } else {
        tile = noise::make_noise_2d(spec).value();
      }
      noise::scale_to_unit_reading(tile);
    }
    for (std::size_t i = 0; i < kWayOctaves; ++i) {
      component.ways[chain * kWayOctaves + i] = way_octave(i, chain_seed + i);
    }
  }
  return component;
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
  const double way_m = std::hypot(east_m_s, south_m_s) * dt_s;
  carried.way_first.add(way_m, way_periods_m_[0]);
  carried.way_second.add(way_m, way_periods_m_[1]);

  if (!evolves_ || turnover_m23_s == 0.0) return;
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

GustNoise::Values GustNoise::at(const Carried& carried, double east_m, double south_m) const noexcept {
  return {read(along_, carried, east_m, south_m), read(across_, carried, east_m, south_m)};
}

WindVector GustNoise::everywhere(const Moment& moment) const noexcept {
  double along = 0.0;
  double across = 0.0;
  for (std::size_t i = 0; i < 2 * kWayOctaves; ++i) {
    const noise::TorusTravel& way = i < kWayOctaves ? moment.carried.way_first : moment.carried.way_second;
    along += static_cast<double>(moment.along_m_s[i] * noise::read_noise(along_.ways[i], way.phase()));
    across += static_cast<double>(moment.across_m_s[i] * noise::read_noise(across_.ways[i], way.phase()));
  }
  return turned(moment.ahead, along, across);
}

std::size_t GustNoise::layers(const Moment& moment, Component component,
                              std::span<Layer, kMaxLayers> out) const noexcept {
  const bool is_along = component == Component::kAlong;
  const Octaves& octaves = is_along ? along_ : across_;
  const auto& weights_m_s = is_along ? moment.along_m_s : moment.across_m_s;
  const Carried& carried = moment.carried;
  std::size_t count = 0;
  for (std::size_t i = 0; i < 2 * kTileOctaves; ++i) {
    const float weight_m_s = weights_m_s[2 * kWayOctaves + i];
    if (weight_m_s < kNothing_m_s) continue;
    const noise::TorusPhase offset = carried.tiles[torus_of(i)].phase();
    out[count++] = {&octaves.tiles[i], i, offset, carried.eddies.cosine[i] * weight_m_s};
    if (evolves_) out[count++] = {&octaves.quarters[i], i, offset, carried.eddies.sine[i] * weight_m_s};
  }
  return count;
}

WindVector GustNoise::local(const Moment& moment, double east_m, double south_m) const noexcept {
  std::array<noise::TorusPhase, kTori> places;
  for (std::size_t i = 0; i < kTori; ++i) {
    places[i] = place_on(i, east_m, south_m) - moment.carried.tiles[i].phase();
  }
  // What layers() lists, octave by octave: its tiles are equally large, and are read at the same place.
  float along = 0.0F;
  float across = 0.0F;
  for (std::size_t i = 0; i < 2 * kTileOctaves; ++i) {
    const float along_m_s = moment.along_m_s[2 * kWayOctaves + i];
    const float across_m_s = moment.across_m_s[2 * kWayOctaves + i];
    const noise::TorusPhase place = places[torus_of(i)];
    const auto log2_size = static_cast<unsigned>(std::countr_zero(along_.tiles[i].size));
    const noise::TorusCorners corners = noise::torus_corners(log2_size, place.x, place.z);
    const float cosine = moment.carried.eddies.cosine[i];
    const float sine = moment.carried.eddies.sine[i];
    const auto add = [&](const Octaves& octaves, float weight_m_s, float& sum) {
      if (weight_m_s < kNothing_m_s) return;
      sum += cosine * weight_m_s * noise::read_corners(octaves.tiles[i].values.data(), corners);
      if (evolves_) sum += sine * weight_m_s * noise::read_corners(octaves.quarters[i].values.data(), corners);
    };
    add(along_, along_m_s, along);
    add(across_, across_m_s, across);
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

std::array<float, GustNoise::kOctaves> GustNoise::read(const Octaves& component, const Carried& carried, double east_m,
                                                       double south_m) const noexcept {
  std::array<float, kOctaves> values{};
  for (std::size_t i = 0; i < 2 * kWayOctaves; ++i) {
    values[i] =
        noise::read_noise(component.ways[i], (i < kWayOctaves ? carried.way_first : carried.way_second).phase());
  }
  for (std::size_t i = 0; i < 2 * kTileOctaves; ++i) {
    // A field that has moved by X is read at x - X; its eddies as far turned as they are.
    const std::size_t torus = torus_of(i);
    const noise::TorusPhase place = place_on(torus, east_m, south_m) - carried.tiles[torus].phase();
    float& value = values[2 * kWayOctaves + i];
    value = noise::read_noise(component.tiles[i], place);
    if (!evolves_) continue;
    value = carried.eddies.cosine[i] * value + carried.eddies.sine[i] * noise::read_noise(component.quarters[i], place);
  }
  return values;
}

double eddy_turnover_m23_s(double sigma_m_s, double length_m) noexcept {
  constexpr double kDissipation = 0.88;
  return kDissipation * sigma_m_s / std::cbrt(length_m);
}

}  // namespace yuragi::wind::turbulence
