#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "engine/math/philox.hpp"
#include "engine/operators/sample_job.hpp"
#include "tests/support/bits.hpp"
#include "tests/support/each_simd_row.hpp"

namespace yuragi::operators {
namespace {

noise::VectorTile2 gusts() {
  return noise::VectorNoiseMaker().make({.size = 64, .seed = 7, .from_cycles = 2.0, .to_cycles = 4.0}, false)->first;
}

constexpr noise::TorusPhase kOffset{123'456'789U, 3'210'987'654U};
/// Three fifths and four fifths.
constexpr float kAheadX = 0.6F, kAheadZ = -0.8F;

struct Places {
  explicit Places(std::size_t count) {
    const math::RandomStream random(1, math::stream_id("places of vectors"));
    for (std::size_t i = 0; i < count; ++i) {
      x.push_back(static_cast<std::uint32_t>(random.uniform(4 * i) * 4294967296.0));
      z.push_back(static_cast<std::uint32_t>(random.uniform(4 * i + 1) * 4294967296.0));
      along_weights.push_back(static_cast<float>(random.uniform(4 * i + 2)));
      across_weights.push_back(static_cast<float>(random.uniform(4 * i + 3)));
    }
  }
  std::vector<std::uint32_t> x, z;
  std::vector<float> along_weights, across_weights;
};

class VectorSampleJobOnEachRow : public EachSimdRow {};
YURAGI_ON_EACH_ROW(VectorSampleJobOnEachRow);

TEST_P(VectorSampleJobOnEachRow, ReadsTheSameBitsAsOnePlaceAtATime) {
  const noise::VectorTile2 tile = gusts();
  for (const std::size_t count : {0U, 1U, 15U, 16U, 17U, 1000U}) {
    const Places places(count);
    std::vector<float> expected_along, expected_across;
    for (std::size_t i = 0; i < count; ++i) {
      const noise::TorusPhase at{places.x[i], places.z[i]};
      const auto along_of = [&](noise::TorusPhase place) {
        return kAheadX * noise::read_noise(tile.x, place) + kAheadZ * noise::read_noise(tile.z, place);
      };
      const auto across_of = [&](noise::TorusPhase place) {
        return kAheadZ * noise::read_noise(tile.x, place) - kAheadX * noise::read_noise(tile.z, place);
      };
      expected_along.push_back(0.5F * along_of(at) + 0.7F * places.along_weights[i] * along_of(at - kOffset));
      expected_across.push_back(0.25F * across_of(at) + 0.3F * places.across_weights[i] * across_of(at - kOffset));
    }
    std::vector<float> along(count), across(count);
    const std::vector<VectorLayer> layers = {{.tile = &tile,
                                              .place_x = places.x,
                                              .place_z = places.z,
                                              .ahead_x = kAheadX,
                                              .ahead_z = kAheadZ,
                                              .along = 0.5F,
                                              .across = 0.25F},
                                             {.tile = &tile,
                                              .place_x = places.x,
                                              .place_z = places.z,
                                              .offset = kOffset,
                                              .ahead_x = kAheadX,
                                              .ahead_z = kAheadZ,
                                              .along = 0.7F,
                                              .across = 0.3F,
                                              .along_weights = places.along_weights,
                                              .across_weights = places.across_weights}};
    const VectorSampleJob job{.layers = layers, .row = GetParam(), .out_along = along, .out_across = across};
    EXPECT_EQ(job.run(), VectorSampleJob::Problem::kNone);
    EXPECT_EQ(bits_of(along), bits_of(expected_along));
    EXPECT_EQ(bits_of(across), bits_of(expected_across));
  }
}

/// Of a tile that turns: two fields of unlike waves.
noise::VectorNoise2 turning(double from_cycles) {
  return noise::VectorNoiseMaker()
      .make({.size = 64, .seed = 11, .from_cycles = from_cycles, .to_cycles = 2.0 * from_cycles}, true)
      .value();
}

TEST_P(VectorSampleJobOnEachRow, ALayerIsStrongerWhereThoseBeforeItFallAhead) {
  constexpr float kCosine = 0.28F, kSine = 0.96F, kStrength = 0.9F, kPerFall_s = 0.4F, kSamplesPerM = 2.0F;
  const noise::VectorNoise2 slow = turning(1.0);
  const noise::VectorNoise2 quick = turning(4.0);
  const Places places(33);  // also some that are read one by one
  const auto layer_of = [&](const noise::VectorNoise2& noise) {
    return VectorLayer{.tile = &noise.first,
                       .quarter = &noise.quarter,
                       .cosine = kCosine,
                       .sine = kSine,
                       .place_x = places.x,
                       .place_z = places.z,
                       .ahead_x = kAheadX,
                       .ahead_z = kAheadZ,
                       .along_weights = places.along_weights};
  };
  const auto read = [&](const std::vector<VectorLayer>& layers) {
    std::array<std::vector<float>, 2> out = {std::vector<float>(places.x.size()), std::vector<float>(places.x.size())};
    const VectorSampleJob job{.layers = layers, .row = GetParam(), .out_along = out[0], .out_across = out[1]};
    EXPECT_EQ(job.run(), VectorSampleJob::Problem::kNone);
    return out;
  };
  VectorLayer first = layer_of(slow);
  VectorLayer second = layer_of(quick);
  const auto slow_only = read({first});
  const auto quick_only = read({second});
  first.samples_per_m = kSamplesPerM;
  second.strength = kStrength;
  second.strength_per_fall_s = kPerFall_s;
  const auto both = read({first, second});

  for (std::size_t i = 0; i < places.x.size(); ++i) {
    // What the first has ahead and behind, within the cell, where it is nearly straight.
    const auto slow_at = [&](double samples) {
      const auto step = [samples](float ahead) {
        return static_cast<std::uint32_t>(static_cast<std::int64_t>(samples * static_cast<double>(ahead) * 0x1p26));
      };
      const noise::TorusPhase at{places.x[i] + step(kAheadX), places.z[i] + step(kAheadZ)};
      const auto mixed = [&](const noise::Tile2& tile, const noise::Tile2& quarter) {
        return kCosine * noise::read_noise(tile, at) + kSine * noise::read_noise(quarter, at);
      };
      return kAheadX * mixed(slow.first.x, slow.quarter.x) + kAheadZ * mixed(slow.first.z, slow.quarter.z);
    };
    EXPECT_NEAR(slow_only[0][i], places.along_weights[i] * slow_at(0.0), 1e-5F);
    const float fall = -kSamplesPerM * places.along_weights[i] * (slow_at(0.5) - slow_at(-0.5));
    const float strength = kStrength + kPerFall_s * fall;
    for (std::size_t component = 0; component < 2; ++component) {
      EXPECT_NEAR(both[component][i] - slow_only[component][i], strength * quick_only[component][i], 0.06F);
    }
  }
}

TEST(VectorSampleJob, WithoutLayersAllIsStill) {
  std::vector<float> along(5, 1.0F), across(5, 1.0F);
  EXPECT_EQ((VectorSampleJob{.layers = {}, .out_along = along, .out_across = across}.run()),
            VectorSampleJob::Problem::kNone);
  EXPECT_EQ(along, std::vector<float>(5));
  EXPECT_EQ(across, std::vector<float>(5));
}

TEST(VectorSampleJob, RefusesWhatCannotBeRead) {
  const noise::VectorTile2 tile = gusts();
  const Places places(4);
  std::vector<float> along(4), across(4);
  const VectorLayer good{.tile = &tile, .place_x = places.x, .place_z = places.z};
  const auto problem_of = [&](VectorLayer layer) {
    return VectorSampleJob{.layers = {&layer, 1}, .out_along = along, .out_across = across}.validate();
  };
  EXPECT_EQ(problem_of(good), VectorSampleJob::Problem::kNone);

  VectorLayer layer = good;
  layer.tile = nullptr;
  EXPECT_EQ(problem_of(layer), VectorSampleJob::Problem::kTileNotReadable);
  const noise::VectorTile2 lame{.x = tile.x, .z = {}};
  layer.tile = &lame;
  EXPECT_EQ(problem_of(layer), VectorSampleJob::Problem::kTileNotReadable);
  layer = good;
  layer.quarter = &lame;
  EXPECT_EQ(problem_of(layer), VectorSampleJob::Problem::kTileNotReadable);
  const noise::VectorTile2 small =
      noise::VectorNoiseMaker().make({.size = 32, .seed = 7, .from_cycles = 2.0, .to_cycles = 4.0}, false)->first;
  layer.quarter = &small;
  EXPECT_EQ(problem_of(layer), VectorSampleJob::Problem::kTileNotReadable);
  layer = good;
  layer.strength_per_fall_s = std::numeric_limits<float>::infinity();
  EXPECT_EQ(problem_of(layer), VectorSampleJob::Problem::kWeightNotFinite);
  layer = good;
  layer.place_z = layer.place_z.first(3);
  EXPECT_EQ(problem_of(layer), VectorSampleJob::Problem::kSizesDiffer);
  layer = good;
  layer.across_weights = std::span(places.across_weights).first(3);
  EXPECT_EQ(problem_of(layer), VectorSampleJob::Problem::kSizesDiffer);
  layer = good;
  layer.across = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(problem_of(layer), VectorSampleJob::Problem::kWeightNotFinite);

  std::vector<VectorLayer> many(VectorSampleJob::kMaxLayers + 1, good);
  EXPECT_EQ((VectorSampleJob{.layers = many, .out_along = along, .out_across = across}.validate()),
            VectorSampleJob::Problem::kLayerCount);
  across.pop_back();
  EXPECT_EQ(problem_of(good), VectorSampleJob::Problem::kSizesDiffer);
}

}  // namespace
}  // namespace yuragi::operators
