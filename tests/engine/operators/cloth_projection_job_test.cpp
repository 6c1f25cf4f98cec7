#include "engine/operators/cloth_projection_job.hpp"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "engine/math/philox.hpp"
#include "tests/support/bits.hpp"
#include "tests/support/each_simd_row.hpp"

namespace yuragi::operators {
namespace {

constexpr std::size_t kClothLinks = 40;
constexpr float kClothLink_m = 0.05F;

/// A cloth that hangs somehow, and leans anyhow.
struct HangingCloth {
  explicit HangingCloth(std::size_t stride, float strength = 1.0F)
      : threads(make_threads(kClothLinks, kClothLink_m, anything(2 * stride, 0.3F, 1))),
        lean(anything(2 * stride * kClothLinks, strength, 2)) {
    for (auto* offset_m : {&pose.offset_x_m, &pose.offset_y_m, &pose.offset_z_m}) {
      offset_m->assign((kClothLinks + 1) * stride, 9.0F);
    }
  }
  static std::vector<float> anything(std::size_t count, float strength, std::uint64_t seed) {
    const math::RandomStream random(seed, math::stream_id("cloth projection job test"));
    std::vector<float> values(count);
    for (std::size_t i = 0; i < count; ++i) values[i] = strength * static_cast<float>(2.0 * random.uniform(i) - 1.0);
    return values;
  }
  ClothProjectionJob job() { return {.threads = &threads, .lean = lean, .pose = &pose}; }

  /// Where a joint is, the fixed edge's being the origin.
  std::vector<double> joint(std::size_t column, std::size_t row) const {
    const std::size_t stride = threads.stride;
    const auto rest = [&](std::size_t part) { return static_cast<double>(threads.rest_end_m[part * stride + column]); };
    const auto links = static_cast<double>(row);
    const std::size_t at = row * stride + column;
    return {links * rest(0) + static_cast<double>(pose.offset_x_m[at]),
            links * (static_cast<double>(kClothLink_m) - rest(1)) + static_cast<double>(pose.offset_y_m[at]),
            links * rest(2) + static_cast<double>(pose.offset_z_m[at])};
  }

  ClothThreads threads;
  std::vector<float> lean;
  pose::GridPose pose;
};

class ClothProjectionJobOnEachRow : public EachSimdRow {};
YURAGI_ON_EACH_ROW(ClothProjectionJobOnEachRow);

TEST_P(ClothProjectionJobOnEachRow, ComputesTheSameBitsAsTheBaseRow) {
  HangingCloth expected(48);
  HangingCloth cloth(48);
  ClothProjectionJob base = expected.job();
  base.row = kBaseSimdRow;
  EXPECT_EQ(base.run(), ClothProjectionJob::Problem::kNone);
  ClothProjectionJob job = cloth.job();
  job.row = GetParam();
  EXPECT_EQ(job.run(), ClothProjectionJob::Problem::kNone);
  EXPECT_EQ(bits_of(cloth.pose.offset_x_m), bits_of(expected.pose.offset_x_m));
  EXPECT_EQ(bits_of(cloth.pose.offset_y_m), bits_of(expected.pose.offset_y_m));
  EXPECT_EQ(bits_of(cloth.pose.offset_z_m), bits_of(expected.pose.offset_z_m));
}

TEST_P(ClothProjectionJobOnEachRow, AnEdgeThatStandsElsewhereTakesItsThreadsAlong) {
  HangingCloth cloth(32);
  HangingCloth moved(32);
  const std::vector<float> edge_m = HangingCloth::anything(3 * 32, 0.5F, 3);
  ClothProjectionJob job = cloth.job();
  job.row = GetParam();
  ASSERT_EQ(job.run(), ClothProjectionJob::Problem::kNone);
  ClothProjectionJob moved_job = moved.job();
  moved_job.row = GetParam();
  moved_job.edge_m = edge_m;
  ASSERT_EQ(moved_job.run(), ClothProjectionJob::Problem::kNone);
  for (std::size_t column = 0; column < 32; ++column) {
    EXPECT_EQ(moved.pose.offset_y_m[column], edge_m[32 + column]);
    for (const std::size_t row : {std::size_t{0}, kClothLinks / 2, kClothLinks}) {
      const std::vector<double> from = cloth.joint(column, row);
      const std::vector<double> to = moved.joint(column, row);
      for (std::size_t axis = 0; axis < 3; ++axis) {
        EXPECT_NEAR(to[axis] - from[axis], edge_m[axis * 32 + column], 1e-5);
      }
    }
  }
  moved_job.edge_m = std::span(edge_m).first(32);
  EXPECT_EQ(moved_job.run(), ClothProjectionJob::Problem::kEdgeSize);
}

TEST_P(ClothProjectionJobOnEachRow, TheLeansOfRestAreExactlyNoOffset) {
  HangingCloth cloth(32);
  for (std::size_t link = 0; link < kClothLinks; ++link) {
    std::copy(cloth.threads.rest_lean.begin(), cloth.threads.rest_lean.end(),
              cloth.lean.begin() + static_cast<std::ptrdiff_t>(link * 64));
  }
  ClothProjectionJob job = cloth.job();
  job.row = GetParam();
  job.run();
  for (const auto* offset_m : {&cloth.pose.offset_x_m, &cloth.pose.offset_y_m, &cloth.pose.offset_z_m}) {
    EXPECT_EQ(*offset_m, std::vector<float>(offset_m->size(), 0.0F));
  }
}

TEST(ClothProjectionJobTest, LinksKeepTheirLengthHoweverTheyLeanAndTheFixedEdgeStays) {
  for (const float strength : {0.1F, 1.0F, 30.0F}) {
    HangingCloth cloth(16, strength);
    cloth.job().run();
    for (std::size_t column = 0; column < 16; ++column) {
      EXPECT_EQ(cloth.pose.offset_x_m[column], 0.0F);
      EXPECT_EQ(cloth.pose.offset_y_m[column], 0.0F);
      EXPECT_EQ(cloth.pose.offset_z_m[column], 0.0F);
      for (std::size_t row = 0; row < kClothLinks; ++row) {
        const auto from = cloth.joint(column, row);
        const auto to = cloth.joint(column, row + 1);
        EXPECT_NEAR(std::hypot(to[0] - from[0], to[1] - from[1], to[2] - from[2]), kClothLink_m, 2e-6);
      }
    }
  }
}

TEST(ClothProjectionJobTest, ALinkIsTurnedByTwiceTheArcTangentOfItsLeanTowardIt) {
  HangingCloth cloth(16);
  for (std::size_t link = 0; link < kClothLinks; ++link) {
    for (std::size_t column = 0; column < 16; ++column) {
      const double azimuth_rad = 0.4 * static_cast<double>(column);  // from east toward south
      cloth.lean[link * 32 + column] = static_cast<float>(std::tan(0.6) * std::cos(azimuth_rad));
      cloth.lean[link * 32 + 16 + column] = static_cast<float>(std::tan(0.6) * std::sin(azimuth_rad));
    }
  }
  cloth.job().run();
  const double length_m = static_cast<double>(kClothLink_m) * static_cast<double>(kClothLinks);
  for (std::size_t column = 0; column < 16; ++column) {
    const double azimuth_rad = 0.4 * static_cast<double>(column);
    const auto end = cloth.joint(column, kClothLinks);
    EXPECT_NEAR(end[0], length_m * std::sin(1.2) * std::cos(azimuth_rad), 1e-5);
    EXPECT_NEAR(end[1], -length_m * std::cos(1.2), 1e-5);
    EXPECT_NEAR(end[2], length_m * std::sin(1.2) * std::sin(azimuth_rad), 1e-5);
  }
}

TEST(ClothProjectionJobTest, BandsMakeTheWhole) {
  HangingCloth whole(16);
  HangingCloth bands(16);
  whole.job().run();
  // (clang 14 optimizes the same with std::min() and the library's assertions to code that fails at the last band.)
  for (std::size_t link = 0, end = 0; link < kClothLinks; link = end) {
    end = link + 7 < kClothLinks ? link + 7 : kClothLinks;
    ClothProjectionJob job = bands.job();
    job.first_link = link;
    job.lean = job.lean.first(end * 32).subspan(link * 32);
    EXPECT_EQ(job.run(), ClothProjectionJob::Problem::kNone);
  }
  EXPECT_EQ(bits_of(bands.pose.offset_x_m), bits_of(whole.pose.offset_x_m));
  EXPECT_EQ(bits_of(bands.pose.offset_y_m), bits_of(whole.pose.offset_y_m));
}

TEST(ClothProjectionJobTest, SaysWhatIsWrongAndThenDoesNothing) {
  using Problem = ClothProjectionJob::Problem;
  HangingCloth cloth(16);
  ClothProjectionJob job = cloth.job();
  job.pose = nullptr;
  EXPECT_EQ(job.run(), Problem::kMissingPart);
  job = cloth.job();
  job.threads = nullptr;
  EXPECT_EQ(job.run(), Problem::kMissingPart);
  job = cloth.job();
  job.first_link = 1;
  EXPECT_EQ(job.run(), Problem::kLeanSize);
  job.lean = job.lean.first(33);
  EXPECT_EQ(job.run(), Problem::kLeanSize);
  ClothThreads odd = cloth.threads;
  odd.stride = 15;
  job = cloth.job();
  job.threads = &odd;
  EXPECT_EQ(job.run(), Problem::kThreadsSize);
  cloth.pose.offset_z_m.pop_back();
  EXPECT_EQ(cloth.job().run(), Problem::kPoseSize);
  EXPECT_EQ(cloth.pose.offset_x_m, std::vector<float>(cloth.pose.offset_x_m.size(), 9.0F));
}

}  // namespace
}  // namespace yuragi::operators
