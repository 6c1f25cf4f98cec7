#include "engine/operators/coat_bending_job.hpp"

#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "engine/math/philox.hpp"
#include "tests/support/bits.hpp"
#include "tests/support/each_simd_row.hpp"

namespace yuragi::operators {
namespace {

/// Hairs on skins that face everywhere, and room for their bends.
struct BlownHairs {
  explicit BlownHairs(std::size_t count) : bend_east(count), bend_south(count) {
    const math::RandomStream random(1, math::stream_id("coat bending test"));
    for (std::size_t i = 0; i < count; ++i) {
      const double up = 2.0 * random.uniform(5 * i) - 1.0;
      const double turn_rad = 2.0 * M_PI * random.uniform(5 * i + 1);
      normal_x.push_back(static_cast<float>(std::sqrt(1.0 - up * up) * std::cos(turn_rad)));
      normal_z.push_back(static_cast<float>(std::sqrt(1.0 - up * up) * std::sin(turn_rad)));
      along.push_back(static_cast<float>(2.0 * random.uniform(5 * i + 2) - 1.0));
      across.push_back(static_cast<float>(2.0 * random.uniform(5 * i + 3) - 1.0));
      flexibility.push_back(static_cast<float>(0.4 + 1.4 * random.uniform(5 * i + 4)));
    }
  }

  CoatBendingJob job(double east_m_s, double south_m_s) {
    return {.wind_east_m_s = east_m_s,
            .wind_south_m_s = south_m_s,
            .normal_x = normal_x,
            .normal_z = normal_z,
            .stroke_along = along,
            .stroke_across = across,
            .flexibility = flexibility,
            .bend_east_rad = bend_east,
            .bend_south_rad = bend_south};
  }

  std::vector<float> normal_x, normal_z, along, across, flexibility, bend_east, bend_south;
};

class CoatBendingOnEachRow : public EachSimdRow {};
YURAGI_ON_EACH_ROW(CoatBendingOnEachRow);

TEST_P(CoatBendingOnEachRow, ComputesTheSameBitsAsTheBaseRow) {
  for (const std::size_t count : {1U, 7U, 16U, 1003U}) {
    BlownHairs expected(count);
    CoatBendingJob base = expected.job(4.0, -7.0);
    base.row = kBaseSimdRow;
    EXPECT_EQ(base.run(), CoatBendingJob::Problem::kNone);
    BlownHairs hairs(count);
    CoatBendingJob job = hairs.job(4.0, -7.0);
    job.row = GetParam();
    EXPECT_EQ(job.run(), CoatBendingJob::Problem::kNone);
    EXPECT_EQ(bits_of(hairs.bend_east), bits_of(expected.bend_east));
    EXPECT_EQ(bits_of(hairs.bend_south), bits_of(expected.bend_south));
  }
}

TEST(CoatBendingJobTest, IsTheFormulaInVectors) {
  BlownHairs hairs(300);
  const CoatBendingJob job = hairs.job(6.0, 3.0);
  ASSERT_EQ(job.run(), CoatBendingJob::Problem::kNone);
  const double speed = std::hypot(6.0, 3.0);
  for (std::size_t i = 0; i < 300; ++i) {
    const auto nx = static_cast<double>(hairs.normal_x[i]);
    const auto nz = static_cast<double>(hairs.normal_z[i]);
    const double ny = std::sqrt(std::max(1.0 - nx * nx - nz * nz, 0.0));
    const double out = 6.0 * nx + 3.0 * nz;
    const double tx = 6.0 - out * nx;
    const double ty = -out * ny;
    const double tz = 3.0 - out * nz;
    const double tangent = std::sqrt(tx * tx + ty * ty + tz * tz);
    const double s = tangent * static_cast<double>(hairs.flexibility[i]) / job.half_bend_speed_m_s;
    const double share = s * s / (1.0 + s * s);
    const double exposure = 1.0 - 0.6 * std::max(out / speed, 0.0);
    const double along = share * (job.max_bend_rad * exposure + job.stroke_rad * static_cast<double>(hairs.along[i]));
    const double across = share * job.stroke_rad * static_cast<double>(hairs.across[i]);
    EXPECT_NEAR(hairs.bend_east[i], (along * 6.0 - across * 3.0) / speed, 2e-5);
    EXPECT_NEAR(hairs.bend_south[i], (along * 3.0 + across * 6.0) / speed, 2e-5);
  }
}

TEST(CoatBendingJobTest, WhatBlowsIntoTheSkinBendsNothingAndCalmIsNoBend) {
  BlownHairs hairs(1);
  hairs.normal_x = {-1.0F};
  hairs.normal_z = {0.0F};
  ASSERT_EQ(hairs.job(10.0, 0.0).run(), CoatBendingJob::Problem::kNone);
  EXPECT_NEAR(hairs.bend_east[0], 0.0F, 1e-6F);
  EXPECT_NEAR(hairs.bend_south[0], 0.0F, 1e-6F);
  BlownHairs calm(50);
  ASSERT_EQ(calm.job(0.0, 0.0).run(), CoatBendingJob::Problem::kNone);
  for (std::size_t i = 0; i < 50; ++i) {
    EXPECT_EQ(calm.bend_east[i], 0.0F);
    EXPECT_EQ(calm.bend_south[i], 0.0F);
  }
}

TEST(CoatBendingJobTest, SaysWhatIsWrongAndThenDoesNothing) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  BlownHairs hairs(5);
  EXPECT_EQ(hairs.job(nan, 0.0).run(), CoatBendingJob::Problem::kWindNotFinite);
  CoatBendingJob job = hairs.job(1.0, 0.0);
  job.half_bend_speed_m_s = 0.0;
  EXPECT_EQ(job.run(), CoatBendingJob::Problem::kHalfBendSpeed);
  for (const double bend_rad : {-0.1, 3.2, nan}) {
    job = hairs.job(1.0, 0.0);
    job.max_bend_rad = bend_rad;
    EXPECT_EQ(job.run(), CoatBendingJob::Problem::kBend);
    job = hairs.job(1.0, 0.0);
    job.stroke_rad = bend_rad;
    EXPECT_EQ(job.run(), CoatBendingJob::Problem::kBend);
  }
  job = hairs.job(1.0, 0.0);
  job.sheltered = 1.1;
  EXPECT_EQ(job.run(), CoatBendingJob::Problem::kSheltered);
  job = hairs.job(1.0, 0.0);
  job.stroke_across = job.stroke_across.first(4);
  EXPECT_EQ(job.run(), CoatBendingJob::Problem::kSizesDiffer);
  for (const float bend_rad : hairs.bend_east) EXPECT_EQ(bend_rad, 0.0F);
}

}  // namespace
}  // namespace yuragi::operators
