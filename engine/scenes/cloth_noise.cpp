#include "engine/scenes/cloth_noise.hpp"

#include "engine/noise/spectral_noise.hpp"
#include "engine/operators/sample_job.hpp"
#include "engine/operators/shift_job.hpp"

namespace yuragi {
namespace {

constexpr std::size_t kClothTileSamples = 256;

/// Of noise of variance 1: what is beyond 2.2 standard deviations is cut.
constexpr float kClothNoiseScale = 0.45F;

/// How far from the first noise the second is read, in parts of 2^32 of the tile's period: far on both axes.
constexpr TorusPhase kSecondPlace = {0x80000000U, 0x5A000000U};

}  // namespace

ClothNoise::ClothNoise(const ParameterValues& values, std::uint64_t seed, SimdRow row)
    : period_m_(values.number("tile_period")),
      row_(row),
      tile_(make_noise_2d({.size = kClothTileSamples, .beta = values.number("beta"), .seed = seed}).value()) {}

NoisePlaces ClothNoise::places(std::span<const double> x_m, std::span<const double> z_m) const {
  NoisePlaces places;
  for (const double x : x_m) places.x.push_back(torus_phase(x, period_m_));
  for (const double z : z_m) places.z.push_back(torus_phase(z, period_m_));
  return places;
}

void ClothNoise::shift(double wind_east_m_s, double wind_south_m_s, double dt_s) noexcept {
  ShiftJob{.wind_east_m_s = wind_east_m_s,
           .wind_south_m_s = wind_south_m_s,
           .dt_s = dt_s,
           .period_m = period_m_,
           .offset = &offset_}
      .run();
}

void ClothNoise::sample(const NoisePlaces& places, Channel channel, std::span<float> out) const noexcept {
  SampleJob{.tile = &tile_,
            .place_x = places.x,
            .place_z = places.z,
            .offset = channel == kFirstNoise ? offset_.phase() : offset_.phase() - kSecondPlace,
            .scale = kClothNoiseScale,
            .low = -1.0F,
            .high = 1.0F,
            .row = row_,
            .out = out}
      .run();
}

}  // namespace yuragi
