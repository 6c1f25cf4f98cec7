#include "engine/operators/grid_sample_job.hpp"

#include <algorithm>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "engine/math/philox.hpp"
#include "engine/noise/spectral_noise.hpp"
#include "engine/operators/sample_job.hpp"
#include "tests/support/bits.hpp"
#include "tests/support/each_simd_row.hpp"

namespace yuragi::operators {
namespace {

/// A grid's axes as phases.
struct GridAxes {
  std::vector<std::uint32_t> column_x, row_z;
};

/// `pitch`: from a place to the next, as a part of the period.
GridAxes grid_axes(std::size_t columns, std::size_t rows, double first, double pitch) {
  GridAxes axes;
  for (std::size_t i = 0; i < columns; ++i) {
    axes.column_x.push_back(noise::torus_phase(first + pitch * static_cast<double>(i), 1.0));
  }
  for (std::size_t i = 0; i < rows; ++i) {
    axes.row_z.push_back(noise::torus_phase(0.3 + 0.9 * pitch * static_cast<double>(i), 1.0));
  }
  return axes;
}

/// What SampleJob says, place by place.
std::vector<float> by_places(std::span<const GridNoiseLayer> layers) {
  std::vector<std::vector<std::uint32_t>> x(layers.size());
  std::vector<std::vector<std::uint32_t>> z(layers.size());
  std::vector<NoiseLayer> read;
  for (std::size_t i = 0; i < layers.size(); ++i) {
    for (const std::uint32_t row : layers[i].row_z) {
      for (const std::uint32_t column : layers[i].column_x) {
        x[i].push_back(column);
        z[i].push_back(row);
      }
    }
    read.push_back({.tile = layers[i].tile,
                    .place_x = x[i],
                    .place_z = z[i],
                    .offset = layers[i].offset,
                    .weight = layers[i].weight});
  }
  std::vector<float> out(x[0].size());
  EXPECT_EQ((SampleJob{.layers = read, .row = kBaseSimdRow, .out = out}.run()), SampleJob::Problem::kNone);
  return out;
}

class GridSampleJobOnEachRow : public EachSimdRow {};
YURAGI_ON_EACH_ROW(GridSampleJobOnEachRow);

TEST_P(GridSampleJobOnEachRow, ReadsTheSameBitsAsPlaceByPlace) {
  const noise::Tile2 fine = noise::make_noise_2d({.size = 256, .seed = 1}).value();
  const noise::Tile2 coarse = noise::make_noise_2d({.size = 16, .seed = 2}).value();
  const math::RandomStream random(3, math::stream_id("grids to read"));
  std::uint64_t drawn = 0;
  const auto any_phase = [&] { return static_cast<std::uint32_t>(random.uniform(drawn++) * 4294967296.0); };
  // Pitches from a small part of a sample to many samples, from west to east and back; the seam is in most of them.
  for (const double pitch : {1e-5, 0.001, 0.0041, 0.0073, 0.03, 0.21, -0.004}) {
    for (const std::size_t columns : {1U, 15U, 16U, 17U, 40U, 200U}) {
      const GridAxes one = grid_axes(columns, 23, 0.1, pitch);
      const GridAxes other = grid_axes(columns, 23, 0.7, 1.7 * pitch);
      const std::vector<GridNoiseLayer> layers = {
          {&fine, one.column_x, one.row_z, {any_phase(), any_phase()}, 0.75F},
          {&coarse, other.column_x, other.row_z, {any_phase(), any_phase()}, -0.5F},
          {&fine, other.column_x, one.row_z, {any_phase(), any_phase()}, 1.0F},
      };
      for (std::size_t count = 1; count <= layers.size(); ++count) {
        const auto read = std::span(layers).first(count);
        std::vector<float> out(columns * 23, -7.0F);
        EXPECT_EQ((GridSampleJob{.layers = read, .row = GetParam(), .out = out}.run()), GridSampleJob::Problem::kNone);
        ASSERT_EQ(bits_of(out), bits_of(by_places(read))) << pitch << ", " << columns << ", " << count;
      }
    }
  }
}

TEST_P(GridSampleJobOnEachRow, ReadsNothingBehindTheLastSample) {
  // A tile in a vector of its own, so that a sanitizer sees; all columns in its last samples, all rows in its last two.
  const noise::Tile2 tile = noise::make_noise_2d({.size = 64, .seed = 5}).value();
  for (std::uint32_t first = 0; first < 64; ++first) {
    GridAxes axes;
    for (std::uint32_t i = 0; i < 32; ++i) axes.column_x.push_back((first << 26U) + (i << 23U));
    axes.row_z = {(62U << 26U) + 5U, (63U << 26U) + 9U};
    const GridNoiseLayer layer{&tile, axes.column_x, axes.row_z};
    std::vector<float> out(64);
    EXPECT_EQ((GridSampleJob{.layers = {&layer, 1}, .row = GetParam(), .out = out}.run()),
              GridSampleJob::Problem::kNone);
    ASSERT_EQ(bits_of(out), bits_of(by_places({&layer, 1}))) << first;
  }
}

TEST(GridSampleJobTest, SaysWhatIsWrongAndThenDoesNothing) {
  const noise::Tile2 tile = noise::make_noise_2d({.size = 16, .seed = 1}).value();
  const GridAxes axes = grid_axes(20, 3, 0.0, 0.01);
  std::vector<float> out(60, -7.0F);
  const GridNoiseLayer good_layer{&tile, axes.column_x, axes.row_z};
  const GridSampleJob good{.layers = {&good_layer, 1}, .out = out};
  EXPECT_EQ(good.validate(), GridSampleJob::Problem::kNone);

  GridSampleJob job = good;
  job.layers = {};
  EXPECT_EQ(job.run(), GridSampleJob::Problem::kLayerCount);
  const std::vector<GridNoiseLayer> many(GridSampleJob::kMaxLayers + 1, good_layer);
  job.layers = many;
  EXPECT_EQ(job.run(), GridSampleJob::Problem::kLayerCount);

  GridNoiseLayer layer = good_layer;
  job.layers = {&layer, 1};
  layer.tile = nullptr;
  EXPECT_EQ(job.run(), GridSampleJob::Problem::kTileNotReadable);
  layer = good_layer;
  layer.row_z = layer.row_z.first(2);
  EXPECT_EQ(job.run(), GridSampleJob::Problem::kSizesDiffer);
  const std::vector<GridNoiseLayer> differing = {good_layer, {&tile, std::span(axes.column_x).first(5), axes.row_z}};
  job.layers = differing;
  EXPECT_EQ(job.run(), GridSampleJob::Problem::kSizesDiffer);
  layer = good_layer;
  layer.weight = std::numeric_limits<float>::quiet_NaN();
  job.layers = {&layer, 1};
  EXPECT_EQ(job.run(), GridSampleJob::Problem::kWeightNotNumber);
  EXPECT_EQ(std::count(out.begin(), out.end(), -7.0F), 60);
}

}  // namespace
}  // namespace yuragi::operators
