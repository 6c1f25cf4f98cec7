#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "engine/math/philox.hpp"
#include "engine/operators/displacement_job.hpp"
#include "engine/operators/threshold_ramp_job.hpp"
#include "tests/support/bits.hpp"
#include "tests/support/each_simd_row.hpp"

// The operators that make surfaces: threshold ramp, color mapping, displacement.

namespace yuragi::operators {
namespace {

constexpr float kNoNumber = std::numeric_limits<float>::quiet_NaN();

std::vector<float> normals(std::size_t count, std::string_view stream) {
  const math::RandomStream random(3, math::stream_id(stream));
  std::vector<float> values;
  for (std::size_t i = 0; i < count; ++i) values.push_back(static_cast<float>(random.normal(i)));
  return values;
}

/// 0 to 1 in equal steps.
std::vector<float> rising(std::size_t count) {
  std::vector<float> values;
  for (std::size_t i = 0; i < count; ++i) values.push_back(static_cast<float>(i) / static_cast<float>(count - 1));
  return values;
}

class SurfaceJobsOnEachRow : public EachSimdRow {};
YURAGI_ON_EACH_ROW(SurfaceJobsOnEachRow);

TEST_P(SurfaceJobsOnEachRow, HaveTheBitsOfTheBaseRow) {
  for (const std::size_t count : {0U, 1U, 7U, 16U, 33U, 1000U}) {
    const std::vector<float> noise = normals(count, "noise");
    const std::vector<float> along = normals(count, "along");
    const auto run = [&](SimdRow row) {
      std::vector<float> out(2 * count);
      const auto level = std::span(out).first(count);
      EXPECT_EQ((ThresholdRampJob{.noise = noise, .along = along, .edge = 0.7F, .row = row, .level = level}.run()),
                ThresholdRampJob::Problem::kNone);
      EXPECT_EQ((DisplacementJob{.noise = noise,
                                 .share = along,
                                 .amplitude_m = 0.3,
                                 .row = row,
                                 .displacement_m = std::span(out).last(count)}
                     .run()),
                DisplacementJob::Problem::kNone);
      return bits_of(out);
    };
    EXPECT_EQ(run(GetParam()), run(kBaseSimdRow));
  }
}

TEST(ThresholdRampJobTest, ShowsLessAndLessOfTheNoiseAlongTheAxis) {
  constexpr std::size_t kCount = 20'000;
  const std::vector<float> noise = normals(kCount, "noise");
  const std::vector<float> along = rising(kCount);
  std::vector<float> level(kCount);
  ThresholdRampJob{
      .noise = noise, .along = along, .first_threshold = -2.0F, .last_threshold = 3.0F, .edge = 0.5F, .level = level}
      .run();
  std::size_t shown_before = 2000;
  for (std::size_t tenth = 0; tenth < 10; ++tenth) {
    std::size_t shown = 0;
    for (std::size_t i = 2000 * tenth; i < 2000 * (tenth + 1); ++i) {
      ASSERT_GE(level[i], 0.0F);
      ASSERT_LE(level[i], 1.0F);
      // Shown is what is above the threshold, and fully what is above it by the edge.
      const float threshold = -2.0F + 5.0F * along[i];
      if (noise[i] < threshold - 1e-5F) {
        ASSERT_EQ(level[i], 0.0F);
      } else if (noise[i] > threshold + 0.5F + 1e-5F) {
        ASSERT_EQ(level[i], 1.0F);
      }
      shown += level[i] > 0.0F ? 1U : 0U;
    }
    EXPECT_LE(shown, shown_before);
    shown_before = shown;
  }
  EXPECT_LT(shown_before, 20U);  // 3 in 1000 normals are above 2.75
}

TEST(ThresholdRampJobTest, ItsEdgeIsSoftAndNowhereSteeperThanItSays) {
  const std::vector<float> noise = rising(10'001);
  const std::vector<float> along(noise.size(), 0.0F);
  std::vector<float> level(noise.size());
  ThresholdRampJob{.noise = noise, .along = along, .first_threshold = 0.3F, .edge = 0.4F, .level = level}.run();
  for (std::size_t i = 1; i < level.size(); ++i) {
    const float step = level[i] - level[i - 1];
    ASSERT_GE(step, -1e-6F);
    ASSERT_LE(step, 1.5F / 0.4F * 1.01e-4F + 1e-6F);
  }
  EXPECT_EQ(level.front(), 0.0F);
  EXPECT_NEAR(level[5000], 0.5F, 1e-4F);
  EXPECT_EQ(level.back(), 1.0F);
}

TEST(ThresholdRampJobTest, MayWriteOverItsNoise) {
  std::vector<float> noise = normals(100, "noise");
  const std::vector<float> along = rising(100);
  std::vector<float> level(100);
  ThresholdRampJob{.noise = noise, .along = along, .level = level}.run();
  ThresholdRampJob{.noise = noise, .along = along, .level = noise}.run();
  EXPECT_EQ(noise, level);
}

TEST(ThresholdRampJobTest, SaysWhatIsWrongAndThenDoesNothing) {
  const std::vector<float> noise = normals(10, "noise");
  std::vector<float> level(10, -1.0F);
  const ThresholdRampJob good{.noise = noise, .along = noise, .level = level};
  EXPECT_EQ(good.validate(), ThresholdRampJob::Problem::kNone);
  ThresholdRampJob job = good;
  job.along = job.along.first(9);
  EXPECT_EQ(job.run(), ThresholdRampJob::Problem::kSizesDiffer);
  job = good;
  job.level = job.level.first(9);
  EXPECT_EQ(job.run(), ThresholdRampJob::Problem::kSizesDiffer);
  for (const float edge : {0.0F, -1.0F, 1e-40F, kNoNumber, std::numeric_limits<float>::infinity()}) {
    job = good;
    job.edge = edge;
    EXPECT_EQ(job.run(), ThresholdRampJob::Problem::kEdge) << edge;
  }
  job = good;
  job.last_threshold = kNoNumber;
  EXPECT_EQ(job.run(), ThresholdRampJob::Problem::kThresholdNotNumber);
  EXPECT_EQ(std::count(level.begin(), level.end(), -1.0F), 10);
}

TEST(DisplacementJobTest, MovesEachPointByItsShareOfTheNoise) {
  const std::vector<float> noise = normals(50, "noise");
  std::vector<float> share = rising(50);
  std::vector<float> moved_m(50);
  EXPECT_EQ((DisplacementJob{.noise = noise, .share = share, .amplitude_m = 0.25, .displacement_m = moved_m}.run()),
            DisplacementJob::Problem::kNone);
  EXPECT_EQ(moved_m[0], 0.0F);
  for (std::size_t i = 0; i < 50; ++i) EXPECT_NEAR(moved_m[i], 0.25F * share[i] * noise[i], 1e-7F);

  // Calm: exactly flat.
  DisplacementJob{.noise = noise, .share = share, .amplitude_m = 0.0, .displacement_m = moved_m}.run();
  EXPECT_EQ(bits_of(moved_m), bits_of(std::vector<float>(50)));
}

TEST(DisplacementJobTest, SaysWhatIsWrongAndThenDoesNothing) {
  const std::vector<float> noise(5, 1.0F);
  std::vector<float> moved_m(5, -1.0F);
  const DisplacementJob good{.noise = noise, .share = noise, .amplitude_m = 1.0, .displacement_m = moved_m};
  EXPECT_EQ(good.validate(), DisplacementJob::Problem::kNone);
  DisplacementJob job = good;
  job.amplitude_m = static_cast<double>(kNoNumber);
  EXPECT_EQ(job.run(), DisplacementJob::Problem::kAmplitudeNotNumber);
  job = good;
  job.share = job.share.first(4);
  EXPECT_EQ(job.run(), DisplacementJob::Problem::kSizesDiffer);
  job = good;
  job.displacement_m = job.displacement_m.first(4);
  EXPECT_EQ(job.run(), DisplacementJob::Problem::kSizesDiffer);
  EXPECT_EQ(std::count(moved_m.begin(), moved_m.end(), -1.0F), 5);
}

}  // namespace
}  // namespace yuragi::operators
