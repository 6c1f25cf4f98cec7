// What moves a tree's crown: WindSideJob, SplitJob, TiltJob, FlutterJob.

#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "engine/math/philox.hpp"
#include "engine/operators/flutter_job.hpp"
#include "engine/operators/split_job.hpp"
#include "engine/operators/tilt_job.hpp"
#include "engine/operators/wind_side_job.hpp"
#include "tests/support/bits.hpp"
#include "tests/support/each_simd_row.hpp"

namespace yuragi {
namespace {

constexpr double kNotANumber = std::numeric_limits<double>::quiet_NaN();

std::vector<float> normal_numbers(std::size_t count, double scale, std::uint64_t seed) {
  const RandomStream random(seed, stream_id("crown jobs test"));
  std::vector<float> values;
  for (std::size_t i = 0; i < count; ++i) values.push_back(static_cast<float>(scale * random.normal(i)));
  return values;
}
std::vector<float> uniform_numbers(std::size_t count, double low, double high, std::uint64_t seed) {
  const RandomStream random(seed, stream_id("crown jobs test"));
  std::vector<float> values;
  for (std::size_t i = 0; i < count; ++i) values.push_back(static_cast<float>(low + (high - low) * random.uniform(i)));
  return values;
}

// ---- WindSideJob

/// Places all over a disc of radius 1, and their distances.
struct Sides {
  explicit Sides(std::size_t count = 100)
      : x(uniform_numbers(count, -0.7, 0.7, 1)), z(uniform_numbers(count, -0.7, 0.7, 2)), distance(count) {}

  WindSideJob job(double azimuth_rad, double speed_m_s) {
    return {.wind_east_m_s = speed_m_s * std::sin(azimuth_rad),
            .wind_south_m_s = -speed_m_s * std::cos(azimuth_rad),
            .place_x = x,
            .place_z = z,
            .distance = distance};
  }

  std::vector<float> x, z, distance;
};

TEST(WindSideJobTest, GrowsFromTheFloorAtTheWindwardSideToTwoAtTheLee) {
  Sides sides(3);
  sides.x = {-1.0F, 0.0F, 1.0F};
  sides.z = {0.0F, 0.0F, 0.0F};
  sides.job(std::numbers::pi / 2.0, 50.0).run();  // toward east
  EXPECT_NEAR(sides.distance[0], 0.4F, 0.01F);
  EXPECT_NEAR(sides.distance[1], 1.0F, 0.01F);
  EXPECT_NEAR(sides.distance[2], 2.0F, 0.01F);
}

TEST(WindSideJobTest, IsContinuousAsTheWindTurns) {
  Sides sides;
  sides.job(0.0, 10.0).run();
  const double step_rad = 0.001;
  for (int step = 1; step < 6300; ++step) {
    const std::vector<float> before = sides.distance;
    sides.job(step_rad * step, 10.0).run();
    for (std::size_t i = 0; i < before.size(); ++i) {
      ASSERT_LE(std::abs(sides.distance[i] - before[i]),
                static_cast<double>(std::hypot(sides.x[i], sides.z[i])) * step_rad + 1e-6);
      ASSERT_GE(sides.distance[i], 0.4F);
    }
  }
}

TEST(WindSideJobTest, CalmHasNoSideAndIsReachedWithoutAJump) {
  Sides here;
  Sides there;
  for (const double speed_m_s : {1e-3, 1e-6, 0.0}) {
    here.job(0.3, speed_m_s).run();
    there.job(3.4, speed_m_s).run();
    for (std::size_t i = 0; i < here.distance.size(); ++i) {
      EXPECT_NEAR(here.distance[i], there.distance[i], 2.1 * speed_m_s + 1e-6);
    }
  }
}

TEST(WindSideJobTest, SaysWhatIsWrongAndThenDoesNothing) {
  using Problem = WindSideJob::Problem;
  Sides sides(10);
  EXPECT_EQ(sides.job(0.0, 1.0).validate(), Problem::kNone);
  EXPECT_EQ(sides.job(0.0, kNotANumber).run(), Problem::kWindNotFinite);
  EXPECT_EQ(sides.job(0.0, 1e200).run(), Problem::kWindNotFinite);
  for (const double wrong : {0.0, -1.0, kNotANumber, 1e-200, 1e200}) {
    WindSideJob job = sides.job(0.0, 1.0);
    job.calm_m_s = wrong;
    EXPECT_EQ(job.run(), Problem::kCalmSpeed);
  }
  for (const double wrong : {0.0, -1.0, kNotANumber, std::numeric_limits<double>::infinity()}) {
    WindSideJob job = sides.job(0.0, 1.0);
    job.floor = wrong;
    EXPECT_EQ(job.run(), Problem::kFloor);
  }
  WindSideJob job = sides.job(0.0, 1.0);
  job.place_z = job.place_z.first(9);
  EXPECT_EQ(job.run(), Problem::kSizesDiffer);
  for (const float distance : sides.distance) EXPECT_EQ(distance, 0.0F);
}

// ---- SplitJob

/// A noise, the ramp that it is split along, and its parts.
struct Parts {
  explicit Parts(std::size_t count)
      : noise(normal_numbers(count, 1.0, 1)), ramp(uniform_numbers(count, 0.0, 2.0, 2)), above(count), below(count) {}

  SplitJob job(double threshold = -1.5, double rise = 1.5, double width = 1.0) {
    return {.noise = noise,
            .ramp = ramp,
            .threshold = threshold,
            .threshold_rise = rise,
            .width = width,
            .above = above,
            .below = below};
  }

  std::vector<float> noise, ramp, above, below;
};

class CrownJobsOnEachRow : public EachSimdRow {};
YURAGI_ON_EACH_ROW(CrownJobsOnEachRow);

TEST_P(CrownJobsOnEachRow, SplitComputesTheSameBitsAsTheBaseRow) {
  for (const std::size_t count : {1U, 7U, 16U, 100U, 1003U}) {
    Parts expected(count);
    Parts found(count);
    SplitJob base = expected.job();
    SplitJob job = found.job();
    base.row = SimdRow::kX86_64;
    job.row = GetParam();
    EXPECT_EQ(base.run(), SplitJob::Problem::kNone);
    EXPECT_EQ(job.run(), SplitJob::Problem::kNone);
    EXPECT_EQ(bits_of(found.above), bits_of(expected.above));
    EXPECT_EQ(bits_of(found.below), bits_of(expected.below));
  }
}

TEST_P(CrownJobsOnEachRow, TheTwoPartsAddUpToTheNoise) {
  for (const double width : {1e-6, 0.1, 1.0, 10.0}) {
    Parts parts(1000);
    SplitJob job = parts.job(-1.5, 1.5, width);
    job.row = GetParam();
    job.run();
    for (std::size_t i = 0; i < 1000; ++i) EXPECT_NEAR(parts.above[i] + parts.below[i], parts.noise[i], 1e-6F);
  }
}

TEST(SplitJobTest, WhatIsAboveTheThresholdMovesTheOnePartAndWhatIsBelowTheOther) {
  Parts parts(4);
  parts.ramp = {0.0F, 0.0F, 2.0F, 2.0F};
  parts.noise = {1.0F, -0.5F, 0.5F, -1.0F};
  parts.job(-2.0, 2.0, 0.5).run();  // thresholds -2 and 2: all above, all below
  EXPECT_EQ(parts.above, (std::vector<float>{1.0F, -0.5F, 0.0F, 0.0F}));
  EXPECT_EQ(parts.below, (std::vector<float>{0.0F, 0.0F, 0.5F, -1.0F}));
}

TEST(SplitJobTest, NoNoiseIsNothingWhereverTheThresholdIs) {
  Parts parts(100);
  parts.noise.assign(100, 0.0F);
  parts.job().run();
  for (std::size_t i = 0; i < 100; ++i) {
    EXPECT_EQ(parts.above[i], 0.0F);
    EXPECT_EQ(parts.below[i], 0.0F);
  }
}

TEST(SplitJobTest, BothPartsRiseWithTheNoiseAndNeitherFasterThanIt) {
  const float step = 0.001F;
  Parts before(50);
  Parts after(50);
  for (int k = -3000; k < 3000; ++k) {
    const float noise = step * static_cast<float>(k);
    before.noise.assign(50, noise);
    after.noise.assign(50, noise + step);
    before.job().run();
    after.job().run();
    for (std::size_t i = 0; i < 50; ++i) {
      ASSERT_GE(after.above[i] - before.above[i], -1e-6F);
      ASSERT_LE(after.above[i] - before.above[i], step + 1e-6F);
      ASSERT_GE(after.below[i] - before.below[i], -1e-6F);
      ASSERT_LE(after.below[i] - before.below[i], step + 1e-6F);
    }
  }
}

TEST(SplitJobTest, AMovingThresholdMovesThePartsByNoMoreThanItself) {
  const double step = 0.002;
  Parts before(200);
  Parts after(200);
  for (int k = -2000; k < 2000; ++k) {
    const double threshold = step * k;
    before.job(threshold, 0.0).run();
    after.job(threshold + step, 0.0).run();
    for (std::size_t i = 0; i < 200; ++i) ASSERT_LE(std::abs(after.above[i] - before.above[i]), step + 1e-6);
  }
}

TEST(SplitJobTest, SaysWhatIsWrongAndThenDoesNothing) {
  using Problem = SplitJob::Problem;
  Parts parts(10);
  EXPECT_EQ(parts.job().validate(), Problem::kNone);
  EXPECT_EQ(parts.job(kNotANumber).run(), Problem::kThresholdNotFinite);
  EXPECT_EQ(parts.job(0.0, kNotANumber).run(), Problem::kThresholdNotFinite);
  for (const double width : {0.0, -1.0, kNotANumber, 1e30}) {
    EXPECT_EQ(parts.job(0.0, 0.0, width).run(), Problem::kWidth);
  }
  for (int which = 0; which < 3; ++which) {
    SplitJob job = parts.job();
    if (which == 0) job.ramp = job.ramp.first(9);
    if (which == 1) job.above = job.above.first(9);
    if (which == 2) job.below = job.below.first(9);
    EXPECT_EQ(job.run(), Problem::kSizesDiffer);
  }
  for (std::size_t i = 0; i < 10; ++i) EXPECT_EQ(parts.above[i] + parts.below[i], 0.0F);
}

// ---- TiltJob

constexpr double kMaxTilt_rad = 0.6;
constexpr double kMaxSwing_rad = 0.4;

/// Branches of many kinds, and room for their bends.
struct Branches {
  explicit Branches(std::size_t count)
      : vertical(normal_numbers(count, 0.5, 1)),
        horizontal(normal_numbers(count, 0.5, 2)),
        distance(uniform_numbers(count, 0.4, 2.0, 3)),
        gain(uniform_numbers(count, 0.1, 1.0, 4)),
        east(count),
        south(count) {}

  TiltJob job(double azimuth_rad, double speed_m_s) {
    return {.wind_east_m_s = speed_m_s * std::sin(azimuth_rad),
            .wind_south_m_s = -speed_m_s * std::cos(azimuth_rad),
            .vertical = vertical,
            .horizontal = horizontal,
            .distance = distance,
            .gain = gain,
            .alpha_vertical = 0.4,
            .beta_horizontal = 0.1,
            .max_tilt_rad = kMaxTilt_rad,
            .max_swing_rad = kMaxSwing_rad,
            .bend_east_rad = east,
            .bend_south_rad = south};
  }

  std::vector<float> vertical, horizontal, distance, gain, east, south;
};

TEST_P(CrownJobsOnEachRow, TiltComputesTheSameBitsAsTheBaseRow) {
  for (const std::size_t count : {1U, 7U, 16U, 100U, 1003U}) {
    Branches expected(count);
    Branches found(count);
    TiltJob base = expected.job(0.7, 8.0);
    TiltJob job = found.job(0.7, 8.0);
    base.row = SimdRow::kX86_64;
    job.row = GetParam();
    EXPECT_EQ(base.run(), TiltJob::Problem::kNone);
    EXPECT_EQ(job.run(), TiltJob::Problem::kNone);
    EXPECT_EQ(bits_of(found.east), bits_of(expected.east));
    EXPECT_EQ(bits_of(found.south), bits_of(expected.south));
  }
}

TEST(TiltJobTest, FollowsThePapersFormulas) {
  Branches branches(200);
  const double azimuth_rad = 0.7;
  TiltJob job = branches.job(azimuth_rad, 8.0);
  job.run();
  const double s = 8.0 / job.half_tilt_speed_m_s;
  const double wind = s * s / (1.0 + s * s);
  const auto saturated = [](double x) { return x / std::sqrt(1.0 + x * x); };
  for (std::size_t i = 0; i < 200; ++i) {
    const auto number = [i](const std::vector<float>& values) { return static_cast<double>(values[i]); };
    const double x = wind * number(branches.gain) / number(branches.distance);
    const double along = kMaxTilt_rad * saturated(x * (number(branches.vertical) + 0.4));
    const double across = kMaxSwing_rad * saturated(x * (number(branches.horizontal) + 0.1));
    EXPECT_NEAR(branches.east[i], along * std::sin(azimuth_rad) + across * std::cos(azimuth_rad), 1e-6);
    EXPECT_NEAR(branches.south[i], -along * std::cos(azimuth_rad) + across * std::sin(azimuth_rad), 1e-6);
  }
}

TEST(TiltJobTest, CalmIsExactlyNoBendAndNoWindTiltsBeyondTheLargest) {
  Branches branches(200);
  branches.job(0.3, 1e100).run();
  for (std::size_t i = 0; i < 200; ++i) {
    EXPECT_LE(static_cast<double>(std::hypot(branches.east[i], branches.south[i])),
              std::hypot(kMaxTilt_rad, kMaxSwing_rad) + 1e-6);
    EXPECT_NE(branches.east[i], 0.0F);
  }
  branches.job(0.3, 0.0).run();
  for (std::size_t i = 0; i < 200; ++i) {
    EXPECT_EQ(branches.east[i], 0.0F);
    EXPECT_EQ(branches.south[i], 0.0F);
  }
}

TEST(TiltJobTest, SaysWhatIsWrongAndThenDoesNothing) {
  using Problem = TiltJob::Problem;
  Branches branches(10);
  EXPECT_EQ(branches.job(0.0, 1.0).validate(), Problem::kNone);
  EXPECT_EQ(branches.job(0.0, kNotANumber).run(), Problem::kWindNotFinite);
  EXPECT_EQ(branches.job(0.0, 1e200).run(), Problem::kWindNotFinite);
  TiltJob job = branches.job(0.0, 1.0);
  job.half_tilt_speed_m_s = 0.0;
  EXPECT_EQ(job.run(), Problem::kHalfTiltSpeed);
  job = branches.job(0.0, 1.0);
  job.alpha_vertical = kNotANumber;
  EXPECT_EQ(job.run(), Problem::kConstants);
  job = branches.job(0.0, 1.0);
  job.beta_horizontal = kNotANumber;
  EXPECT_EQ(job.run(), Problem::kConstants);
  for (const double angle_rad : {-0.1, 3.2, kNotANumber}) {
    job = branches.job(0.0, 1.0);
    job.max_tilt_rad = angle_rad;
    EXPECT_EQ(job.run(), Problem::kLargestAngles);
    job = branches.job(0.0, 1.0);
    job.max_swing_rad = angle_rad;
    EXPECT_EQ(job.run(), Problem::kLargestAngles);
  }
  for (int which = 0; which < 5; ++which) {
    job = branches.job(0.0, 1.0);
    if (which == 0) job.horizontal = job.horizontal.first(9);
    if (which == 1) job.distance = job.distance.first(9);
    if (which == 2) job.gain = job.gain.first(9);
    if (which == 3) job.bend_east_rad = job.bend_east_rad.first(9);
    if (which == 4) job.bend_south_rad = job.bend_south_rad.first(9);
    EXPECT_EQ(job.run(), Problem::kSizesDiffer);
  }
  for (std::size_t i = 0; i < 10; ++i) EXPECT_EQ(branches.east[i], 0.0F);
}

// ---- FlutterJob

/// Leaves of many kinds, and room for their bends.
struct Leaves {
  explicit Leaves(std::size_t count)
      : noise(normal_numbers(count, 1.0, 1)),
        along(uniform_numbers(count, 0.5, 1.0, 2)),
        across(uniform_numbers(count, -0.5, 0.5, 3)),
        east(count),
        south(count) {}

  FlutterJob job(double east_m_s, double south_m_s) {
    return {.wind_east_m_s = east_m_s,
            .wind_south_m_s = south_m_s,
            .noise = noise,
            .along = along,
            .across = across,
            .lean_rad = 0.4,
            .flutter_rad = 0.3,
            .bend_east_rad = east,
            .bend_south_rad = south};
  }

  std::vector<float> noise, along, across, east, south;
};

TEST_P(CrownJobsOnEachRow, FlutterComputesTheSameBitsAsTheBaseRow) {
  for (const std::size_t count : {1U, 7U, 16U, 100U, 1003U}) {
    Leaves expected(count);
    Leaves found(count);
    FlutterJob base = expected.job(3.0, -4.0);
    FlutterJob job = found.job(3.0, -4.0);
    base.row = SimdRow::kX86_64;
    job.row = GetParam();
    EXPECT_EQ(base.run(), FlutterJob::Problem::kNone);
    EXPECT_EQ(job.run(), FlutterJob::Problem::kNone);
    EXPECT_EQ(bits_of(found.east), bits_of(expected.east));
    EXPECT_EQ(bits_of(found.south), bits_of(expected.south));
  }
}

TEST(FlutterJobTest, LeansAndFluttersAlongTheWindAndAcrossIt) {
  Leaves leaves(100);
  FlutterJob job = leaves.job(0.0, 1.0);  // toward south: west is on the right
  job.half_flutter_speed_m_s = 1.0;
  job.run();
  for (std::size_t i = 0; i < 100; ++i) {
    const float bend_rad = 0.5F * (0.4F + 0.3F * leaves.noise[i]);
    EXPECT_NEAR(leaves.south[i], bend_rad * leaves.along[i], 1e-6F);
    EXPECT_NEAR(leaves.east[i], -bend_rad * leaves.across[i], 1e-6F);
  }
}

TEST(FlutterJobTest, CalmIsExactlyNoBend) {
  Leaves leaves(100);
  leaves.job(5.0, 5.0).run();
  leaves.job(0.0, 0.0).run();
  for (std::size_t i = 0; i < 100; ++i) {
    EXPECT_EQ(leaves.east[i], 0.0F);
    EXPECT_EQ(leaves.south[i], 0.0F);
  }
}

TEST(FlutterJobTest, SaysWhatIsWrongAndThenDoesNothing) {
  using Problem = FlutterJob::Problem;
  Leaves leaves(10);
  EXPECT_EQ(leaves.job(1.0, 1.0).validate(), Problem::kNone);
  EXPECT_EQ(leaves.job(kNotANumber, 1.0).run(), Problem::kWindNotFinite);
  EXPECT_EQ(leaves.job(1.0, 1e200).run(), Problem::kWindNotFinite);
  FlutterJob job = leaves.job(1.0, 1.0);
  job.half_flutter_speed_m_s = 0.001;
  EXPECT_EQ(job.run(), Problem::kHalfFlutterSpeed);
  job = leaves.job(1.0, 1.0);
  job.lean_rad = kNotANumber;
  EXPECT_EQ(job.run(), Problem::kAngles);
  job = leaves.job(1.0, 1.0);
  job.flutter_rad = kNotANumber;
  EXPECT_EQ(job.run(), Problem::kAngles);
  for (int which = 0; which < 4; ++which) {
    job = leaves.job(1.0, 1.0);
    if (which == 0) job.along = job.along.first(9);
    if (which == 1) job.across = job.across.first(9);
    if (which == 2) job.bend_east_rad = job.bend_east_rad.first(9);
    if (which == 3) job.bend_south_rad = job.bend_south_rad.first(9);
    EXPECT_EQ(job.run(), Problem::kSizesDiffer);
  }
  for (std::size_t i = 0; i < 10; ++i) EXPECT_EQ(leaves.east[i], 0.0F);
}

}  // namespace
}  // namespace yuragi
