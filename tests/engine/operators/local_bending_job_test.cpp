#include "engine/operators/local_bending_job.hpp"

#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "engine/math/philox.hpp"
#include "engine/operators/bending_job.hpp"
#include "tests/support/bits.hpp"
#include "tests/support/each_simd_row.hpp"

namespace yuragi::operators {
namespace {

/// Strands, each in a wind of its own, and room for their bends.
struct BlownStrands {
  explicit BlownStrands(std::size_t count) : bend_east(count), bend_south(count) {
    const math::RandomStream random(1, math::stream_id("local bending test"));
    for (std::size_t i = 0; i < count; ++i) {
      east.push_back(static_cast<float>(40.0 * (random.uniform(3 * i) - 0.5)));
      south.push_back(static_cast<float>(40.0 * (random.uniform(3 * i + 1) - 0.5)));
      strength.push_back(static_cast<float>(0.6 + 0.8 * random.uniform(count + i)));
      flexibility.push_back(static_cast<float>(0.3 + 1.5 * random.uniform(3 * i + 2)));
    }
  }

  LocalBendingJob job() {
    return {.wind_east_m_s = east,
            .wind_south_m_s = south,
            .strength = strength,
            .flexibility = flexibility,
            .half_bend_speed_m_s = 7.0,
            .max_bend_rad = 1.4,
            .bend_east_rad = bend_east,
            .bend_south_rad = bend_south};
  }

  std::vector<float> east, south, strength, flexibility, bend_east, bend_south;
};

class LocalBendingOnEachRow : public EachSimdRow {};
YURAGI_ON_EACH_ROW(LocalBendingOnEachRow);

TEST_P(LocalBendingOnEachRow, ComputesTheSameBitsAsTheBaseRow) {
  for (const std::size_t count : {1U, 7U, 16U, 1003U}) {
    BlownStrands expected(count);
    LocalBendingJob base = expected.job();
    base.row = kBaseSimdRow;
    EXPECT_EQ(base.run(), LocalBendingJob::Problem::kNone);
    BlownStrands strands(count);
    LocalBendingJob job = strands.job();
    job.row = GetParam();
    EXPECT_EQ(job.run(), LocalBendingJob::Problem::kNone);
    EXPECT_EQ(bits_of(strands.bend_east), bits_of(expected.bend_east));
    EXPECT_EQ(bits_of(strands.bend_south), bits_of(expected.bend_south));
  }
}

TEST(LocalBendingJobTest, BendsAsBendingJobDoesInThatWind) {
  BlownStrands strands(300);
  ASSERT_EQ(strands.job().run(), LocalBendingJob::Problem::kNone);
  for (std::size_t i = 0; i < 300; ++i) {
    float east_rad = 0.0F;
    float south_rad = 0.0F;
    BendingJob{.wind_east_m_s = static_cast<double>(strands.east[i]),
               .wind_south_m_s = static_cast<double>(strands.south[i]),
               .strength = std::span(strands.strength).subspan(i, 1),
               .flexibility = std::span(strands.flexibility).subspan(i, 1),
               .half_bend_speed_m_s = 7.0,
               .max_bend_rad = 1.4,
               .bend_east_rad = std::span(&east_rad, 1),
               .bend_south_rad = std::span(&south_rad, 1)}
        .run();
    EXPECT_NEAR(strands.bend_east[i], east_rad, 2e-6);
    EXPECT_NEAR(strands.bend_south[i], south_rad, 2e-6);
  }
}

TEST(LocalBendingJobTest, CalmIsNoBendAndNoStormBendsBeyondTheLargest) {
  BlownStrands strands(3);
  strands.east = {0.0F, 1e18F, 1e-30F};
  strands.south = {0.0F, -1e18F, 0.0F};
  ASSERT_EQ(strands.job().run(), LocalBendingJob::Problem::kNone);
  EXPECT_EQ(strands.bend_east[0], 0.0F);
  EXPECT_EQ(strands.bend_south[0], 0.0F);
  EXPECT_TRUE(std::isfinite(strands.bend_east[1]));
  EXPECT_LE(std::hypot(strands.bend_east[2], strands.bend_south[2]), 1e-6F);
}

TEST(LocalBendingJobTest, SaysWhatIsWrongAndThenDoesNothing) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  BlownStrands strands(5);
  for (const double speed_m_s : {0.0, nan}) {
    LocalBendingJob job = strands.job();
    job.half_bend_speed_m_s = speed_m_s;
    EXPECT_EQ(job.run(), LocalBendingJob::Problem::kHalfBendSpeed);
  }
  for (const double bend_rad : {-0.1, 3.2, nan}) {
    LocalBendingJob job = strands.job();
    job.max_bend_rad = bend_rad;
    EXPECT_EQ(job.run(), LocalBendingJob::Problem::kMaxBend);
  }
  LocalBendingJob job = strands.job();
  job.wind_south_m_s = job.wind_south_m_s.first(4);
  EXPECT_EQ(job.run(), LocalBendingJob::Problem::kSizesDiffer);
  for (const float bend_rad : strands.bend_east) EXPECT_EQ(bend_rad, 0.0F);
}

}  // namespace
}  // namespace yuragi::operators
