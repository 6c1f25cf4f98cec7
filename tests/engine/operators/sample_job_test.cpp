#include "engine/operators/sample_job.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "engine/math/philox.hpp"
#include "engine/noise/spectral_noise.hpp"
#include "engine/operators/shift_job.hpp"
#include "tests/support/bits.hpp"
#include "tests/support/each_simd_row.hpp"

namespace yuragi::operators {
namespace {

constexpr double kFieldPeriod_m = 64.0;
constexpr std::size_t kTileSize = 128;
constexpr double kCell_m = kFieldPeriod_m / static_cast<double>(kTileSize);

noise::Tile2 wind_tile() {
  return noise::make_noise_2d({.size = kTileSize, .seed = 7}).value();
}

/// Places of a meadow, or of something else that reads the field.
struct Places {
  std::vector<std::uint32_t> x, z;

  void add(double x_m, double z_m) {
    x.push_back(noise::torus_phase(x_m, kFieldPeriod_m));
    z.push_back(noise::torus_phase(z_m, kFieldPeriod_m));
  }
};

/// A grid, strayed from so that no place is at a sample; moved as a whole by (x_m, z_m).
Places grid(double x_m, double z_m) {
  Places places;
  for (int row = 0; row < 30; ++row) {
    for (int column = 0; column < 30; ++column) places.add(0.71 * column + x_m, 0.67 * row + z_m);
  }
  return places;
}

std::vector<float> read(const noise::Tile2& tile, const Places& places, noise::TorusPhase offset) {
  std::vector<float> values(places.x.size());
  const NoiseLayer layer{.tile = &tile, .place_x = places.x, .place_z = places.z, .offset = offset};
  const SampleJob job{.layers = {&layer, 1}, .out = values};
  EXPECT_EQ(job.run(), SampleJob::Problem::kNone);
  return values;
}

double correlation(const std::vector<float>& a, const std::vector<float>& b) {
  double sum_a = 0, sum_b = 0, aa = 0, bb = 0, ab = 0;
  const auto count = static_cast<double>(a.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    const auto p = static_cast<double>(a[i]);
    const auto q = static_cast<double>(b[i]);
    sum_a += p, sum_b += q, aa += p * p, bb += q * q, ab += p * q;
  }
  return (ab - sum_a * sum_b / count) / std::sqrt((aa - sum_a * sum_a / count) * (bb - sum_b * sum_b / count));
}

class SampleJobOnEachRow : public EachSimdRow {};
YURAGI_ON_EACH_ROW(SampleJobOnEachRow);

TEST_P(SampleJobOnEachRow, ReadsTheSameBitsAsOnePlaceAtATime) {
  const noise::Tile2 tile = wind_tile();
  const math::RandomStream random(1, math::stream_id("places"));
  const noise::TorusPhase offset{123'456'789U, 3'210'987'654U};
  for (const std::size_t count : {0U, 1U, 15U, 16U, 17U, 64U, 1000U}) {
    std::vector<std::uint32_t> x;
    std::vector<std::uint32_t> z;
    std::vector<float> expected;
    for (std::size_t i = 0; i < count; ++i) {
      x.push_back(static_cast<std::uint32_t>(random.uniform(2 * i) * 4294967296.0));
      z.push_back(static_cast<std::uint32_t>(random.uniform(2 * i + 1) * 4294967296.0));
      expected.push_back(noise::read_noise(tile, noise::TorusPhase{x.back(), z.back()} - offset));
    }
    std::vector<float> out(count);
    const NoiseLayer layer{.tile = &tile, .place_x = x, .place_z = z, .offset = offset};
    EXPECT_EQ((SampleJob{.layers = {&layer, 1}, .row = GetParam(), .out = out}.run()), SampleJob::Problem::kNone);
    EXPECT_EQ(bits_of(out), bits_of(expected));
  }
}

TEST_P(SampleJobOnEachRow, ScalesAndKeepsWithinTheRange) {
  const noise::Tile2 tile = wind_tile();
  const Places places = grid(0.0, 0.0);
  const std::vector<float> plain = read(tile, places, {});
  std::vector<float> out(plain.size());
  const NoiseLayer layer{.tile = &tile, .place_x = places.x, .place_z = places.z};
  EXPECT_EQ((SampleJob{.layers = {&layer, 1},
                       .scale = 0.5F,
                       .bias = 1.0F,
                       .low = 0.75F,
                       .high = 1.25F,
                       .row = GetParam(),
                       .out = out}
                 .run()),
            SampleJob::Problem::kNone);
  std::vector<float> expected;
  expected.reserve(plain.size());
  for (const float noise : plain) expected.push_back(std::clamp(1.0F + 0.5F * noise, 0.75F, 1.25F));
  EXPECT_EQ(bits_of(out), bits_of(expected));
  EXPECT_EQ(*std::min_element(out.begin(), out.end()), 0.75F);
  EXPECT_EQ(*std::max_element(out.begin(), out.end()), 1.25F);
}

TEST_P(SampleJobOnEachRow, APlacesWeightMultipliesTheLayers) {
  const noise::Tile2 tile = wind_tile();
  const math::RandomStream random(2, math::stream_id("weights of places"));
  const noise::TorusPhase offset{987'654'321U, 123'456'789U};
  for (const std::size_t count : {1U, 15U, 16U, 17U, 1000U}) {
    std::vector<std::uint32_t> x;
    std::vector<std::uint32_t> z;
    std::vector<float> weights;
    std::vector<float> expected;
    for (std::size_t i = 0; i < count; ++i) {
      x.push_back(static_cast<std::uint32_t>(random.uniform(3 * i) * 4294967296.0));
      z.push_back(static_cast<std::uint32_t>(random.uniform(3 * i + 1) * 4294967296.0));
      weights.push_back(static_cast<float>(random.uniform(3 * i + 2)));
      const noise::TorusPhase at{x.back(), z.back()};
      const float plain = 0.5F * noise::read_noise(tile, at);
      expected.push_back(plain + 0.7F * weights.back() * noise::read_noise(tile, at - offset));
    }
    std::vector<float> out(count);
    const std::vector<NoiseLayer> layers = {
        {.tile = &tile, .place_x = x, .place_z = z, .weight = 0.5F},
        {.tile = &tile, .place_x = x, .place_z = z, .offset = offset, .weight = 0.7F, .weights = weights}};
    EXPECT_EQ((SampleJob{.layers = layers, .row = GetParam(), .out = out}.run()), SampleJob::Problem::kNone);
    EXPECT_EQ(bits_of(out), bits_of(expected));
  }
}

TEST_P(SampleJobOnEachRow, AWeightOfOneAtEachPlaceChangesNoBit) {
  const noise::Tile2 tile = wind_tile();
  const Places places = grid(0.3, 0.2);
  const std::vector<float> ones(places.x.size(), 1.0F);
  std::vector<float> out(places.x.size());
  const NoiseLayer layer{.tile = &tile, .place_x = places.x, .place_z = places.z, .weights = ones};
  EXPECT_EQ((SampleJob{.layers = {&layer, 1}, .row = GetParam(), .out = out}.run()), SampleJob::Problem::kNone);
  EXPECT_EQ(bits_of(out), bits_of(read(tile, places, {})));
}

TEST(SampleJobTest, RefusesWeightsThatAreNotOneForEachPlace) {
  const noise::Tile2 tile = wind_tile();
  const Places places = grid(0.0, 0.0);
  const std::vector<float> too_few(places.x.size() - 1, 1.0F);
  std::vector<float> out(places.x.size());
  const NoiseLayer layer{.tile = &tile, .place_x = places.x, .place_z = places.z, .weights = too_few};
  EXPECT_EQ((SampleJob{.layers = {&layer, 1}, .out = out}.run()), SampleJob::Problem::kSizesDiffer);
}

TEST(SampleJobTest, AFieldThatHasMovedByXIsReadAtXBack) {
  const noise::Tile2 tile = wind_tile();
  const std::vector<float> at_first = read(tile, grid(0.0, 0.0), {});
  for (int azimuth_deg = 0; azimuth_deg < 360; azimuth_deg += 30) {
    // The wind blows toward the azimuth for 2 s: the field goes 12 m that way.
    const double azimuth_rad = azimuth_deg * std::numbers::pi / 180.0;
    const double x_m = 12.0 * std::sin(azimuth_rad);
    const double z_m = -12.0 * std::cos(azimuth_rad);
    noise::TorusOffset offset;
    for (int i = 0; i < 120; ++i) {
      ShiftJob{.wind_east_m_s = x_m / 2.0,
               .wind_south_m_s = z_m / 2.0,
               .dt_s = 1.0 / 60.0,
               .period_m = kFieldPeriod_m,
               .offset = &offset}
          .run();
    }

    // What was here is now there.
    const std::vector<float> there = read(tile, grid(x_m, z_m), offset.phase());
    for (std::size_t i = 0; i < there.size(); ++i) EXPECT_NEAR(there[i], at_first[i], 1e-5F);
  }
}

TEST(SampleJobTest, TheCorrelationPeaksDownwind) {
  const noise::Tile2 tile = wind_tile();
  const std::vector<float> at_first = read(tile, grid(0.0, 0.0), {});
  for (int wind = 0; wind < 8; ++wind) {
    const auto downwind = [](int eighth) {
      const double azimuth_rad = eighth * std::numbers::pi / 4.0;
      return std::pair{5.0 * std::sin(azimuth_rad), -5.0 * std::cos(azimuth_rad)};
    };
    noise::TorusOffset offset;
    offset.x.add(downwind(wind).first, kFieldPeriod_m);
    offset.z.add(downwind(wind).second, kFieldPeriod_m);

    // Of no displacement and those of 5 m in eight directions, the wind's own fits best.
    const double best =
        correlation(at_first, read(tile, grid(downwind(wind).first, downwind(wind).second), offset.phase()));
    EXPECT_GT(best, 0.9999);
    EXPECT_LT(correlation(at_first, read(tile, grid(0.0, 0.0), offset.phase())), best - 0.01);
    for (int other = 0; other < 8; ++other) {
      if (other == wind) continue;
      const auto [x_m, z_m] = downwind(other);
      EXPECT_LT(correlation(at_first, read(tile, grid(x_m, z_m), offset.phase())), best - 0.01) << wind << ' ' << other;
    }
  }
}

TEST(SampleJobTest, NoTurnOfTheWindMovesTheFieldFasterThanTheWindItself) {
  const noise::Tile2 tile = wind_tile();
  float steepest = 0.0F;
  for (std::size_t z = 0; z < kTileSize; ++z) {
    for (std::size_t x = 0; x < kTileSize; ++x) {
      steepest = std::max(steepest, std::abs(tile.at((x + 1) % kTileSize, z) - tile.at(x, z)));
      steepest = std::max(steepest, std::abs(tile.at(x, (z + 1) % kTileSize) - tile.at(x, z)));
    }
  }

  // Far places too: a field that turned would sweep them sideways.
  Places places = grid(0.0, 0.0);
  for (int i = 0; i < 100; ++i) places.add(10'000.0 + 13.7 * i, -20'000.0 + 7.1 * i);
  noise::TorusOffset offset;
  std::vector<float> before = read(tile, places, offset.phase());
  for (int tick = 0; tick < 300; ++tick) {
    // A wind that leaps to another direction every tick.
    const double azimuth_rad = 2.4 * tick;
    const double east_m_s = 9.0 * std::sin(azimuth_rad);
    const double south_m_s = -9.0 * std::cos(azimuth_rad);
    const double dt_s = 1.0 / 60.0;
    ShiftJob{.wind_east_m_s = east_m_s,
             .wind_south_m_s = south_m_s,
             .dt_s = dt_s,
             .period_m = kFieldPeriod_m,
             .offset = &offset}
        .run();
    const std::vector<float> now = read(tile, places, offset.phase());
    const double cells = (std::abs(east_m_s) + std::abs(south_m_s)) * dt_s / kCell_m;
    const float bound = steepest * static_cast<float>(cells) + 1e-5F;
    for (std::size_t i = 0; i < now.size(); ++i) EXPECT_LE(std::abs(now[i] - before[i]), bound);
    before = now;
  }
}

TEST_P(SampleJobOnEachRow, AddsItsLayersInTheirOrder) {
  const noise::Tile2 tile = wind_tile();
  const noise::Tile2 other = noise::make_noise_2d({.size = 64, .seed = 8}).value();
  const Places places = grid(0.0, 0.0);
  const Places elsewhere = grid(5.0, -3.0);
  const std::vector<NoiseLayer> layers = {
      {.tile = &tile, .place_x = places.x, .place_z = places.z, .offset = {1U << 30U, 5U}, .weight = 0.75F},
      {.tile = &other, .place_x = elsewhere.x, .place_z = elsewhere.z, .offset = {7U, 1U << 29U}, .weight = -0.5F}};
  std::vector<float> out(places.x.size());
  EXPECT_EQ((SampleJob{.layers = layers, .row = GetParam(), .out = out}.run()), SampleJob::Problem::kNone);
  for (std::size_t i = 0; i < out.size(); ++i) {
    const float first = 0.75F * noise::read_noise(tile, noise::TorusPhase{places.x[i], places.z[i]} - layers[0].offset);
    const float second =
        -0.5F * noise::read_noise(other, noise::TorusPhase{elsewhere.x[i], elsewhere.z[i]} - layers[1].offset);
    EXPECT_EQ(out[i], first + second) << i;
  }
}

TEST(SampleJobTest, SaysWhatIsWrongAndThenDoesNothing) {
  const noise::Tile2 tile = wind_tile();
  const Places places = grid(0.0, 0.0);
  std::vector<float> out(places.x.size(), -7.0F);
  const NoiseLayer good_layer{.tile = &tile, .place_x = places.x, .place_z = places.z};
  const SampleJob good{.layers = {&good_layer, 1}, .out = out};
  EXPECT_EQ(good.validate(), SampleJob::Problem::kNone);

  SampleJob job = good;
  job.layers = {};
  EXPECT_EQ(job.run(), SampleJob::Problem::kLayerCount);
  const std::vector<NoiseLayer> many(SampleJob::kMaxLayers + 1, good_layer);
  job.layers = many;
  EXPECT_EQ(job.run(), SampleJob::Problem::kLayerCount);

  NoiseLayer layer = good_layer;
  job.layers = {&layer, 1};
  layer.tile = nullptr;
  EXPECT_EQ(job.run(), SampleJob::Problem::kTileNotReadable);
  const noise::Tile2 odd{3, std::vector<float>(9)};
  layer.tile = &odd;
  EXPECT_EQ(job.run(), SampleJob::Problem::kTileNotReadable);
  layer = good_layer;
  layer.place_x = layer.place_x.first(5);
  EXPECT_EQ(job.run(), SampleJob::Problem::kSizesDiffer);
  layer = good_layer;
  layer.place_z = layer.place_z.first(5);
  EXPECT_EQ(job.run(), SampleJob::Problem::kSizesDiffer);
  layer = good_layer;
  layer.weight = std::numeric_limits<float>::infinity();
  EXPECT_EQ(job.run(), SampleJob::Problem::kRangeNotNumber);
  job = good;
  job.scale = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(job.run(), SampleJob::Problem::kRangeNotNumber);
  job = good;
  job.low = 2.0F;
  job.high = 1.0F;
  EXPECT_EQ(job.run(), SampleJob::Problem::kRangeNotNumber);
  EXPECT_EQ(std::count(out.begin(), out.end(), -7.0F), static_cast<std::ptrdiff_t>(out.size()));
}

}  // namespace
}  // namespace yuragi::operators
