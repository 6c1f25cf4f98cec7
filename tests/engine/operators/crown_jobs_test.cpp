// What moves a tree's crown: WindSideJob, SplitJob, BranchForceJob, TiltJob, LeafResponseJob, FlutterJob.

#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "engine/math/philox.hpp"
#include "engine/operators/bend_share.hpp"
#include "engine/operators/branch_force_job.hpp"
#include "engine/operators/flutter_job.hpp"
#include "engine/operators/leaf_response_job.hpp"
#include "engine/operators/split_job.hpp"
#include "engine/operators/streamlined_drag.hpp"
#include "engine/operators/tilt_job.hpp"
#include "engine/operators/wind_side_job.hpp"
#include "tests/support/bits.hpp"
#include "tests/support/each_simd_row.hpp"

namespace yuragi::operators {
namespace {

constexpr double kNotANumber = std::numeric_limits<double>::quiet_NaN();

std::vector<float> normal_numbers(std::size_t count, double scale, std::uint64_t seed) {
  const math::RandomStream random(seed, math::stream_id("crown jobs test"));
  std::vector<float> values;
  for (std::size_t i = 0; i < count; ++i) values.push_back(static_cast<float>(scale * random.normal(i)));
  return values;
}
std::vector<float> uniform_numbers(std::size_t count, double low, double high, std::uint64_t seed) {
  const math::RandomStream random(seed, math::stream_id("crown jobs test"));
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
    base.row = kBaseSimdRow;
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

// ---- BranchForceJob

TEST(StreamlinedDragTest, GrowsWithTheSquareAndThenByVogelsExponent) {
  for (const double speed : {0.0, 0.01, 0.3, 1.0, 2.5, 10.0, 1e3}) {
    const double exact = speed * speed * std::pow(1.0 + speed * speed, -0.375);
    EXPECT_NEAR(streamlined_drag(static_cast<float>(speed * speed)), exact, 1e-6 * exact);
  }
  const auto exponent_at = [](float speed) {
    return std::log(streamlined_drag(1.0201F * speed * speed) / streamlined_drag(speed * speed)) / std::log(1.01F);
  };
  EXPECT_NEAR(exponent_at(0.03F), 2.0F, 0.01F);
  EXPECT_NEAR(exponent_at(300.0F), 1.25F, 0.01F);
}

/// Winds at many branches, and room for what comes of them.
struct Gusts {
  explicit Gusts(std::size_t count)
      : east_m_s(normal_numbers(count, 5.0, 1)),
        south_m_s(normal_numbers(count, 5.0, 2)),
        noise(count),
        toward_east(count),
        toward_south(count) {}

  BranchForceJob job(double mean_m_s) {
    return {.mean_m_s = mean_m_s,
            .wind_east_m_s = east_m_s,
            .wind_south_m_s = south_m_s,
            .noise = noise,
            .toward_east = toward_east,
            .toward_south = toward_south};
  }

  std::vector<float> east_m_s, south_m_s, noise, toward_east, toward_south;
};

TEST_P(CrownJobsOnEachRow, ForceComputesTheSameBitsAsTheBaseRow) {
  for (const std::size_t count : {1U, 7U, 16U, 100U, 1003U}) {
    Gusts expected(count);
    Gusts found(count);
    BranchForceJob base = expected.job(6.0);
    BranchForceJob job = found.job(6.0);
    base.row = kBaseSimdRow;
    job.row = GetParam();
    EXPECT_EQ(base.run(), BranchForceJob::Problem::kNone);
    EXPECT_EQ(job.run(), BranchForceJob::Problem::kNone);
    EXPECT_EQ(bits_of(found.noise), bits_of(expected.noise));
    EXPECT_EQ(bits_of(found.toward_east), bits_of(expected.toward_east));
    EXPECT_EQ(bits_of(found.toward_south), bits_of(expected.toward_south));
  }
}

TEST(BranchForceJobTest, TellsTheForceAgainstThatOfTheMeanWindAndWhereItPullsTo) {
  Gusts gusts(200);
  const auto drag_of = [](double speed_m_s) {
    const double square = speed_m_s * speed_m_s / 36.0;
    return square / std::pow(1.0 + square, 0.375);
  };
  for (const double mean_m_s : {4.0, 0.1}) {
    const BranchForceJob job = gusts.job(mean_m_s);
    job.run();
    const double mean_force = drag_of(std::max(mean_m_s, 0.3));
    EXPECT_NEAR(job.mean_force(), mean_force, 1e-6 * mean_force);
    for (std::size_t i = 0; i < 200; ++i) {
      const auto east = static_cast<double>(gusts.east_m_s[i]);
      const auto south = static_cast<double>(gusts.south_m_s[i]);
      const double force = drag_of(std::hypot(east, south)) / mean_force;
      EXPECT_NEAR(gusts.noise[i], force - 1.0, 1e-5 * force + 1e-6);
      EXPECT_NEAR(gusts.toward_east[i], east / std::sqrt(east * east + south * south + 0.09), 1e-6);
      EXPECT_NEAR(gusts.toward_south[i], south / std::sqrt(east * east + south * south + 0.09), 1e-6);
    }
  }
}

TEST(BranchForceJobTest, CalmPullsNowhereAndAWindAsTheMeanIsNoNoise) {
  Gusts gusts(2);
  gusts.east_m_s = {0.0F, 3.0F};
  gusts.south_m_s = {0.0F, 4.0F};
  gusts.job(5.0).run();
  EXPECT_EQ(gusts.noise[0], -1.0F);
  EXPECT_EQ(gusts.toward_east[0], 0.0F);
  EXPECT_EQ(gusts.toward_south[0], 0.0F);
  EXPECT_NEAR(gusts.noise[1], 0.0F, 1e-6F);
}

TEST(BranchForceJobTest, SaysWhatIsWrongAndThenDoesNothing) {
  using Problem = BranchForceJob::Problem;
  Gusts gusts(10);
  EXPECT_EQ(gusts.job(1.0).validate(), Problem::kNone);
  for (const double wrong : {-1.0, 1e7, kNotANumber}) {
    EXPECT_EQ(gusts.job(wrong).run(), Problem::kMean);
    BranchForceJob job = gusts.job(1.0);
    job.streamline_speed_m_s = wrong;
    EXPECT_EQ(job.run(), Problem::kStreamlineSpeed);
    job = gusts.job(1.0);
    job.calm_m_s = wrong;
    EXPECT_EQ(job.run(), Problem::kCalmSpeed);
  }
  for (int which = 0; which < 4; ++which) {
    BranchForceJob job = gusts.job(1.0);
    if (which == 0) job.wind_east_m_s = job.wind_east_m_s.first(9);
    if (which == 1) job.wind_south_m_s = job.wind_south_m_s.first(9);
    if (which == 2) job.toward_east = job.toward_east.first(9);
    if (which == 3) job.toward_south = job.toward_south.first(9);
    EXPECT_EQ(job.run(), Problem::kSizesDiffer);
  }
  for (const float noise : gusts.noise) EXPECT_EQ(noise, 0.0F);
}

// ---- TiltJob

constexpr double kMaxTilt_rad = 0.6;
constexpr double kMaxSwing_rad = 0.5;

/// Branches of many kinds in winds of many directions, and room for their bends.
struct Branches {
  explicit Branches(std::size_t count)
      : vertical(normal_numbers(count, 0.5, 1)),
        horizontal(normal_numbers(count, 0.5, 2)),
        distance(uniform_numbers(count, 0.4, 2.0, 3)),
        gain(uniform_numbers(count, 0.01, 0.3, 4)),
        east(count),
        south(count) {
    for (const float azimuth_rad : uniform_numbers(count, 0.0, 6.28, 5)) {
      toward_east.push_back(std::sin(azimuth_rad));
      toward_south.push_back(-std::cos(azimuth_rad));
    }
  }

  TiltJob job(double force) {
    return {.force = force,
            .toward_east = toward_east,
            .toward_south = toward_south,
            .vertical = vertical,
            .horizontal = horizontal,
            .distance = distance,
            .gain = gain,
            .alpha_vertical = 0.9,
            .beta_horizontal = 0.1,
            .max_tilt_rad = kMaxTilt_rad,
            .max_swing_rad = kMaxSwing_rad,
            .bend_east_rad = east,
            .bend_south_rad = south};
  }

  std::vector<float> toward_east, toward_south, vertical, horizontal, distance, gain, east, south;
};

TEST_P(CrownJobsOnEachRow, TiltComputesTheSameBitsAsTheBaseRow) {
  for (const std::size_t count : {1U, 7U, 16U, 100U, 1003U}) {
    Branches expected(count);
    Branches found(count);
    TiltJob base = expected.job(0.7);
    TiltJob job = found.job(0.7);
    base.row = kBaseSimdRow;
    job.row = GetParam();
    EXPECT_EQ(base.run(), TiltJob::Problem::kNone);
    EXPECT_EQ(job.run(), TiltJob::Problem::kNone);
    EXPECT_EQ(bits_of(found.east), bits_of(expected.east));
    EXPECT_EQ(bits_of(found.south), bits_of(expected.south));
  }
}

TEST(TiltJobTest, FollowsThePapersFormulas) {
  Branches branches(200);
  branches.job(1.3).run();
  const auto capped = [](double x, double most) { return x / std::sqrt(1.0 + (x / most) * (x / most)); };
  for (std::size_t i = 0; i < 200; ++i) {
    const auto number = [i](const std::vector<float>& values) { return static_cast<double>(values[i]); };
    const double reach = 1.3 * number(branches.gain) / number(branches.distance);
    const double along = capped(reach * (number(branches.vertical) + 0.9), kMaxTilt_rad);
    const double across = capped(reach * (number(branches.horizontal) + 0.1), kMaxSwing_rad);
    const double east = number(branches.toward_east);
    const double south = number(branches.toward_south);
    EXPECT_NEAR(branches.east[i], along * east - across * south, 1e-6);
    EXPECT_NEAR(branches.south[i], along * south + across * east, 1e-6);
  }
}

TEST(TiltJobTest, AWindThatBlowsNowhereIsExactlyNoBendAndNoForceTiltsBeyondTheLargest) {
  Branches branches(200);
  branches.job(1e6).run();
  for (std::size_t i = 0; i < 200; ++i) {
    EXPECT_LE(static_cast<double>(std::hypot(branches.east[i], branches.south[i])),
              std::hypot(kMaxTilt_rad, kMaxSwing_rad) + 1e-6);
    EXPECT_NE(branches.east[i], 0.0F);
  }
  branches.toward_east.assign(200, 0.0F);
  branches.toward_south.assign(200, 0.0F);
  branches.job(1e6).run();
  for (std::size_t i = 0; i < 200; ++i) {
    EXPECT_EQ(branches.east[i], 0.0F);
    EXPECT_EQ(branches.south[i], 0.0F);
  }
}

TEST(TiltJobTest, WhatMayNotBendDoesNot) {
  Branches branches(20);
  TiltJob job = branches.job(1.0);
  job.max_tilt_rad = job.max_swing_rad = 0.0;
  EXPECT_EQ(job.run(), TiltJob::Problem::kNone);
  for (std::size_t i = 0; i < 20; ++i) EXPECT_EQ(std::hypot(branches.east[i], branches.south[i]), 0.0F);
}

TEST(TiltJobTest, SaysWhatIsWrongAndThenDoesNothing) {
  using Problem = TiltJob::Problem;
  Branches branches(10);
  EXPECT_EQ(branches.job(1.0).validate(), Problem::kNone);
  for (const double wrong : {-0.1, 2e6, kNotANumber}) EXPECT_EQ(branches.job(wrong).run(), Problem::kForce);
  TiltJob job = branches.job(1.0);
  job.alpha_vertical = kNotANumber;
  EXPECT_EQ(job.run(), Problem::kConstants);
  job = branches.job(1.0);
  job.beta_horizontal = kNotANumber;
  EXPECT_EQ(job.run(), Problem::kConstants);
  for (const double angle_rad : {-0.1, 3.2, kNotANumber}) {
    job = branches.job(1.0);
    job.max_tilt_rad = angle_rad;
    EXPECT_EQ(job.run(), Problem::kMaxAngles);
    job = branches.job(1.0);
    job.max_swing_rad = angle_rad;
    EXPECT_EQ(job.run(), Problem::kMaxAngles);
  }
  for (int which = 0; which < 7; ++which) {
    job = branches.job(1.0);
    if (which == 0) job.horizontal = job.horizontal.first(9);
    if (which == 1) job.distance = job.distance.first(9);
    if (which == 2) job.gain = job.gain.first(9);
    if (which == 3) job.bend_east_rad = job.bend_east_rad.first(9);
    if (which == 4) job.bend_south_rad = job.bend_south_rad.first(9);
    if (which == 5) job.toward_east = job.toward_east.first(9);
    if (which == 6) job.toward_south = job.toward_south.first(9);
    EXPECT_EQ(job.run(), Problem::kSizesDiffer);
  }
  for (std::size_t i = 0; i < 10; ++i) EXPECT_EQ(branches.east[i], 0.0F);
}

// ---- LeafResponseJob

/// Winds at many places, and room for how leaves answer them.
struct LeafPlaces {
  explicit LeafPlaces(std::size_t count)
      : east_m_s(normal_numbers(count, 5.0, 1)),
        south_m_s(normal_numbers(count, 5.0, 2)),
        lean_east(count),
        lean_south(count),
        flutter(count) {}

  LeafResponseJob job() {
    return {.wind_east_m_s = east_m_s,
            .wind_south_m_s = south_m_s,
            .lean_rad = 0.4,
            .flutter_rad = 0.3,
            .lean_east_rad = lean_east,
            .lean_south_rad = lean_south,
            .flutter_rad_each = flutter};
  }

  std::vector<float> east_m_s, south_m_s, lean_east, lean_south, flutter;
};

TEST_P(CrownJobsOnEachRow, LeafResponseComputesTheSameBitsAsTheBaseRow) {
  for (const std::size_t count : {1U, 7U, 16U, 100U, 1003U}) {
    LeafPlaces expected(count);
    LeafPlaces found(count);
    LeafResponseJob base = expected.job();
    LeafResponseJob job = found.job();
    base.row = kBaseSimdRow;
    job.row = GetParam();
    EXPECT_EQ(base.run(), LeafResponseJob::Problem::kNone);
    EXPECT_EQ(job.run(), LeafResponseJob::Problem::kNone);
    EXPECT_EQ(bits_of(found.lean_east), bits_of(expected.lean_east));
    EXPECT_EQ(bits_of(found.lean_south), bits_of(expected.lean_south));
    EXPECT_EQ(bits_of(found.flutter), bits_of(expected.flutter));
  }
}

TEST(LeafResponseJobTest, LeansWithTheWindAndFluttersTheMoreTheStrongerItIs) {
  LeafPlaces places(200);
  places.job().run();
  for (std::size_t i = 0; i < 200; ++i) {
    const auto east = static_cast<double>(places.east_m_s[i]);
    const auto south = static_cast<double>(places.south_m_s[i]);
    const double speed_m_s = std::hypot(east, south);
    const double s = speed_m_s / 4.0;
    const double lean = 0.4 * s * s / (1.0 + s * s) / speed_m_s;
    EXPECT_NEAR(places.lean_east[i], lean * east, 1e-6);
    EXPECT_NEAR(places.lean_south[i], lean * south, 1e-6);
    const double q = speed_m_s * speed_m_s / 25.0;
    EXPECT_NEAR(places.flutter[i], 0.3 * (1.0 - std::pow(1.0 + q / 8.0, -8.0)), 1e-6);
    EXPECT_NEAR(places.flutter[i], 0.3 * (1.0 - std::exp(-q)), 0.033 * 0.3);
  }
}

TEST(LeafResponseJobTest, IsNowhereSteeperThanItSays) {
  LeafPlaces places(6000);
  for (std::size_t i = 0; i < 6000; ++i) places.east_m_s[i] = 0.005F * static_cast<float>(i);
  places.south_m_s.assign(6000, 0.0F);
  places.job().run();
  double lean = 0.0;
  double flutter = 0.0;
  for (std::size_t i = 1; i < 6000; ++i) {
    lean = std::max(lean, static_cast<double>(places.lean_east[i] - places.lean_east[i - 1]) / 0.4 / (0.005 / 4.0));
    flutter = std::max(flutter, static_cast<double>(places.flutter[i] - places.flutter[i - 1]) / 0.3 / (0.005 / 5.0));
  }
  EXPECT_NEAR(lean, kSteepestBendShare, 2e-3);
  EXPECT_NEAR(flutter, LeafResponseJob::kSteepestFlutter, 2e-3);
}

TEST(LeafResponseJobTest, CalmIsExactlyNothingAndNoWindIsTooStrong) {
  LeafPlaces places(2);
  places.east_m_s = {0.0F, 1e6F};
  places.south_m_s = {0.0F, 1e6F};
  places.job().run();
  EXPECT_EQ(places.lean_east[0], 0.0F);
  EXPECT_EQ(places.lean_south[0], 0.0F);
  EXPECT_EQ(places.flutter[0], 0.0F);
  EXPECT_NEAR(std::hypot(places.lean_east[1], places.lean_south[1]), 0.4F, 1e-6F);
  EXPECT_EQ(places.flutter[1], 0.3F);
}

TEST(LeafResponseJobTest, SaysWhatIsWrongAndThenDoesNothing) {
  using Problem = LeafResponseJob::Problem;
  LeafPlaces places(10);
  EXPECT_EQ(places.job().validate(), Problem::kNone);
  for (const double wrong : {0.001, -1.0, 1e7, kNotANumber}) {
    LeafResponseJob job = places.job();
    job.half_lean_speed_m_s = wrong;
    EXPECT_EQ(job.run(), Problem::kSpeeds);
    job = places.job();
    job.flutter_speed_m_s = wrong;
    EXPECT_EQ(job.run(), Problem::kSpeeds);
  }
  LeafResponseJob job = places.job();
  job.lean_rad = kNotANumber;
  EXPECT_EQ(job.run(), Problem::kAngles);
  job = places.job();
  job.flutter_rad = kNotANumber;
  EXPECT_EQ(job.run(), Problem::kAngles);
  for (int which = 0; which < 4; ++which) {
    job = places.job();
    if (which == 0) job.wind_south_m_s = job.wind_south_m_s.first(9);
    if (which == 1) job.lean_east_rad = job.lean_east_rad.first(9);
    if (which == 2) job.lean_south_rad = job.lean_south_rad.first(9);
    if (which == 3) job.flutter_rad_each = job.flutter_rad_each.first(9);
    EXPECT_EQ(job.run(), Problem::kSizesDiffer);
  }
  for (const float flutter : places.flutter) EXPECT_EQ(flutter, 0.0F);
}

// ---- FlutterJob

/// Sprays of leaves at five places, and room for their bends.
struct Leaves {
  explicit Leaves(std::size_t sprays)
      : lean_east(normal_numbers(5, 0.3, 1)),
        lean_south(normal_numbers(5, 0.3, 2)),
        flutter(uniform_numbers(5, 0.0, 0.3, 3)),
        noise(normal_numbers(16 * sprays, 1.0, 4)),
        give(uniform_numbers(16 * sprays, 0.5, 1.0, 5)),
        axis_east(uniform_numbers(16 * sprays, -1.0, 1.0, 6)),
        axis_south(uniform_numbers(16 * sprays, -1.0, 1.0, 7)),
        east(16 * sprays),
        south(16 * sprays) {
    for (std::size_t i = 0; i < sprays; ++i) place.push_back(static_cast<std::uint32_t>(i * 3 % 5));
  }

  FlutterJob job() {
    return {.lean_east_rad = lean_east,
            .lean_south_rad = lean_south,
            .flutter_rad = flutter,
            .place = place,
            .noise = noise,
            .give = give,
            .axis_east = axis_east,
            .axis_south = axis_south,
            .bend_east_rad = east,
            .bend_south_rad = south};
  }

  std::vector<float> lean_east, lean_south, flutter;
  std::vector<std::uint32_t> place;
  std::vector<float> noise, give, axis_east, axis_south, east, south;
};

TEST_P(CrownJobsOnEachRow, FlutterComputesTheSameBitsAsTheBaseRow) {
  for (const std::size_t sprays : {1U, 7U, 100U}) {
    Leaves expected(sprays);
    Leaves found(sprays);
    FlutterJob base = expected.job();
    FlutterJob job = found.job();
    base.row = kBaseSimdRow;
    job.row = GetParam();
    EXPECT_EQ(base.run(), FlutterJob::Problem::kNone);
    EXPECT_EQ(job.run(), FlutterJob::Problem::kNone);
    EXPECT_EQ(bits_of(found.east), bits_of(expected.east));
    EXPECT_EQ(bits_of(found.south), bits_of(expected.south));
  }
}

TEST(FlutterJobTest, LeansAsItsPlaceAndFluttersAlongItsOwnAxis) {
  Leaves leaves(10);
  leaves.job().run();
  for (std::size_t i = 0; i < 160; ++i) {
    const std::size_t place = leaves.place[i / 16];
    const float to_and_fro = leaves.flutter[place] * leaves.noise[i];
    EXPECT_NEAR(leaves.east[i], leaves.give[i] * leaves.lean_east[place] + to_and_fro * leaves.axis_east[i], 1e-6F);
    EXPECT_NEAR(leaves.south[i], leaves.give[i] * leaves.lean_south[place] + to_and_fro * leaves.axis_south[i], 1e-6F);
  }
}

TEST(FlutterJobTest, SaysWhatIsWrongAndThenDoesNothing) {
  using Problem = FlutterJob::Problem;
  Leaves leaves(2);
  EXPECT_EQ(leaves.job().validate(), Problem::kNone);
  for (int which = 0; which < 9; ++which) {
    FlutterJob job = leaves.job();
    if (which == 0) job.lean_east_rad = job.lean_east_rad.first(4);
    if (which == 1) job.lean_south_rad = job.lean_south_rad.first(4);
    if (which == 2) job.place = job.place.first(1);
    if (which == 3) job.noise = job.noise.first(31);
    if (which == 4) job.give = job.give.first(31);
    if (which == 5) job.axis_east = job.axis_east.first(31);
    if (which == 6) job.axis_south = job.axis_south.first(31);
    if (which == 7) job.bend_east_rad = job.bend_east_rad.first(31);
    if (which == 8) job.bend_south_rad = job.bend_south_rad.first(31);
    EXPECT_EQ(job.run(), Problem::kSizesDiffer) << which;
  }
  leaves.place[1] = 5;
  EXPECT_EQ(leaves.job().run(), Problem::kPlace);
  for (const float bend : leaves.east) EXPECT_EQ(bend, 0.0F);
}

}  // namespace
}  // namespace yuragi::operators
