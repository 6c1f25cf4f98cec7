#include "engine/operators/bending_job.hpp"

#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "engine/math/philox.hpp"
#include "tests/support/bits.hpp"
#include "tests/support/each_simd_row.hpp"

namespace yuragi::operators {
namespace {

constexpr double kHalfBendSpeed_m_s = 7.0;
constexpr double kMaxBend_rad = 1.4;

/// Strands of many strengths and flexibilities, and room for their bends.
struct Strands {
  explicit Strands(std::size_t count, std::uint64_t seed = 1) : east(count), south(count) {
    const math::RandomStream random(seed, math::stream_id("bending job test"));
    for (std::size_t i = 0; i < count; ++i) {
      strength.push_back(static_cast<float>(2.5 * random.uniform(2 * i)));
      flexibility.push_back(static_cast<float>(0.3 + 1.5 * random.uniform(2 * i + 1)));
    }
  }

  BendingJob job(double east_m_s, double south_m_s) {
    return {.wind_east_m_s = east_m_s,
            .wind_south_m_s = south_m_s,
            .strength = strength,
            .flexibility = flexibility,
            .half_bend_speed_m_s = kHalfBendSpeed_m_s,
            .max_bend_rad = kMaxBend_rad,
            .bend_east_rad = east,
            .bend_south_rad = south};
  }
  float bend_rad(std::size_t i) const { return std::hypot(east[i], south[i]); }
  float azimuth_rad(std::size_t i) const { return std::atan2(south[i], east[i]); }  ///< from east toward south

  std::vector<float> strength, flexibility, east, south;
};

class BendingJobOnEachRow : public EachSimdRow {};
YURAGI_ON_EACH_ROW(BendingJobOnEachRow);

TEST_P(BendingJobOnEachRow, ComputesTheSameBitsAsTheBaseRow) {
  for (const std::size_t count : {1U, 7U, 16U, 100U, 1003U}) {
    Strands expected(count);
    BendingJob base = expected.job(4.0, -3.0);
    base.row = kBaseSimdRow;
    EXPECT_EQ(base.run(), BendingJob::Problem::kNone);
    Strands strands(count);
    BendingJob job = strands.job(4.0, -3.0);
    job.row = GetParam();
    EXPECT_EQ(job.run(), BendingJob::Problem::kNone);
    EXPECT_EQ(bits_of(strands.east), bits_of(expected.east));
    EXPECT_EQ(bits_of(strands.south), bits_of(expected.south));
  }
}

TEST_P(BendingJobOnEachRow, AStrongerWindNeverBendsLess) {
  // Not by a bit: from a breath to a hurricane in steps of a 10,000th.
  Strands strands(64);
  std::vector<float> before(64, 0.0F);
  double speed_m_s = 0.01;
  while (speed_m_s < 100'000.0) {
    speed_m_s *= 1.0001;
    BendingJob job = strands.job(speed_m_s, 0.0);
    job.row = GetParam();
    job.run();
    for (std::size_t i = 0; i < before.size(); ++i) ASSERT_GE(strands.east[i], before[i]) << speed_m_s;
    before = strands.east;
  }
}

TEST(BendingJobTest, DoublingTheWindNeverBendsLess) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    Strands once(1000, seed);
    Strands twice(1000, seed);
    for (const double speed_m_s : {0.01, 0.5, 3.0, 8.0, 25.0, 60.0}) {
      const double azimuth_rad = 0.7 * static_cast<double>(seed);
      once.job(speed_m_s * std::sin(azimuth_rad), -speed_m_s * std::cos(azimuth_rad)).run();
      twice.job(2.0 * speed_m_s * std::sin(azimuth_rad), -2.0 * speed_m_s * std::cos(azimuth_rad)).run();
      for (std::size_t i = 0; i < 1000; ++i) {
        EXPECT_GE(std::abs(twice.east[i]), std::abs(once.east[i]));
        EXPECT_GE(std::abs(twice.south[i]), std::abs(once.south[i]));
      }
    }
  }
}

TEST(BendingJobTest, CalmIsExactlyNoBend) {
  Strands strands(100);
  strands.job(5.0, 5.0).run();
  for (const double zero : {0.0, -0.0}) {
    strands.job(zero, zero).run();
    for (std::size_t i = 0; i < 100; ++i) {
      EXPECT_EQ(strands.east[i], 0.0F);
      EXPECT_EQ(strands.south[i], 0.0F);
    }
  }
}

TEST(BendingJobTest, TheBendPointsToWhereTheWindBlows) {
  Strands strands(100);
  for (int azimuth_deg = 0; azimuth_deg < 360; azimuth_deg += 15) {
    const double azimuth_rad = azimuth_deg * std::numbers::pi / 180.0;
    strands.job(8.0 * std::sin(azimuth_rad), -8.0 * std::cos(azimuth_rad)).run();
    for (std::size_t i = 0; i < 100; ++i) {
      const float bend_rad = strands.bend_rad(i);
      EXPECT_NEAR(strands.east[i], bend_rad * static_cast<float>(std::sin(azimuth_rad)), 1e-6F);
      EXPECT_NEAR(strands.south[i], -bend_rad * static_cast<float>(std::cos(azimuth_rad)), 1e-6F);
    }
  }
}

TEST(BendingJobTest, TurningTheWindTurnsTheLeanByTheSameAngle) {
  Strands before(100);
  Strands after(100);
  before.job(6.0, 2.0).run();
  const double turn_rad = 0.6;
  const double cosine = std::cos(turn_rad);
  const double sine = std::sin(turn_rad);
  after.job(6.0 * cosine - 2.0 * sine, 6.0 * sine + 2.0 * cosine).run();
  for (std::size_t i = 0; i < 100; ++i) {
    EXPECT_NEAR(after.bend_rad(i), before.bend_rad(i), 1e-6F);
    EXPECT_NEAR(after.azimuth_rad(i) - before.azimuth_rad(i), turn_rad, 1e-5);
  }
}

TEST(BendingJobTest, HalfBendSpeedBendsHalfAndNoWindBendsBeyondTheLargest) {
  Strands strands(1);
  strands.strength = {1.0F};
  strands.flexibility = {1.0F};
  strands.job(kHalfBendSpeed_m_s, 0.0).run();
  EXPECT_NEAR(strands.bend_rad(0), kMaxBend_rad / 2.0, 1e-6);
  for (const double speed_m_s : {50.0, 1e3, 1e9, 1e150}) {
    strands.job(speed_m_s, 0.0).run();
    EXPECT_LE(strands.bend_rad(0), static_cast<float>(kMaxBend_rad));
    EXPECT_GT(strands.bend_rad(0), 0.97F * static_cast<float>(kMaxBend_rad));
  }
}

TEST(BendingJobTest, MoreFlexibleStrandsBendMore) {
  Strands strands(2);
  strands.strength = {1.0F, 1.0F};
  strands.flexibility = {0.8F, 1.2F};
  strands.job(5.0, 0.0).run();
  EXPECT_GT(strands.bend_rad(1), 1.2F * strands.bend_rad(0));
}

TEST(BendingJobTest, AStrengthBelowZeroIsNone) {
  Strands strands(1);
  strands.strength = {-1.0F};
  strands.job(5.0, 0.0).run();
  EXPECT_EQ(strands.bend_rad(0), 0.0F);
}

TEST(BendingJobTest, ASmallChangeOfTheWindIsASmallChangeOfTheBend) {
  // The steepest that s^2 / (1 + s^2) gets is 3 sqrt(3) / 8, where s is 1 / sqrt(3).
  const double steepest_rad_s_m = kMaxBend_rad * 3.0 * std::sqrt(3.0) / 8.0 / kHalfBendSpeed_m_s;
  Strands before(200);
  Strands after(200);
  const double change_m_s = 0.02;
  for (int tenths = 0; tenths < 300; ++tenths) {
    const double speed_m_s = 0.1 * tenths;
    before.job(speed_m_s, 0.0).run();
    after.job(speed_m_s + change_m_s, 0.0).run();
    for (std::size_t i = 0; i < 200; ++i) {
      const double felt_m_s = change_m_s * static_cast<double>(before.strength[i] * before.flexibility[i]);
      EXPECT_LE(after.east[i] - before.east[i], steepest_rad_s_m * felt_m_s + 1e-6);
    }
  }
}

TEST(BendingJobTest, SaysWhatIsWrongAndThenDoesNothing) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  Strands strands(10);
  EXPECT_EQ(strands.job(1.0, 1.0).validate(), BendingJob::Problem::kNone);
  EXPECT_EQ(strands.job(nan, 1.0).run(), BendingJob::Problem::kWindNotFinite);
  EXPECT_EQ(strands.job(1.0, 1e200).run(), BendingJob::Problem::kWindNotFinite);
  BendingJob job = strands.job(1.0, 1.0);
  job.half_bend_speed_m_s = 0.0;
  EXPECT_EQ(job.run(), BendingJob::Problem::kHalfBendSpeed);
  job.half_bend_speed_m_s = nan;
  EXPECT_EQ(job.run(), BendingJob::Problem::kHalfBendSpeed);
  for (const double bend_rad : {-0.1, 3.2, nan}) {
    job = strands.job(1.0, 1.0);
    job.max_bend_rad = bend_rad;
    EXPECT_EQ(job.run(), BendingJob::Problem::kMaxBend);
  }
  job = strands.job(1.0, 1.0);
  job.strength = job.strength.first(9);
  EXPECT_EQ(job.run(), BendingJob::Problem::kSizesDiffer);
  job = strands.job(1.0, 1.0);
  job.bend_south_rad = job.bend_south_rad.first(9);
  EXPECT_EQ(job.run(), BendingJob::Problem::kSizesDiffer);
  for (std::size_t i = 0; i < 10; ++i) EXPECT_EQ(strands.bend_rad(i), 0.0F);
}

}  // namespace
}  // namespace yuragi::operators
