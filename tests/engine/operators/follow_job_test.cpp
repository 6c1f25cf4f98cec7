#include "engine/operators/follow_job.hpp"

#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "engine/math/critically_damped.hpp"
#include "engine/math/philox.hpp"
#include "tests/support/bits.hpp"
#include "tests/support/each_simd_row.hpp"

namespace yuragi {
namespace {

constexpr double kFollowTick_s = 1.0 / 60.0;

struct Followers {
  explicit Followers(std::size_t count) : target(count), value(count), rate(count) {}

  FollowJob job(double dt_s = kFollowTick_s) {
    return {.target = target, .omega_rad_s = 9.0, .dt_s = dt_s, .value = value, .rate_per_s = rate};
  }
  void jump(std::uint64_t tick) {
    const RandomStream random(7, stream_id("follow job test"));
    for (std::size_t i = 0; i < target.size(); ++i) {
      target[i] = static_cast<float>(2.0 * random.uniform(tick * 64 + i) - 1.0);
    }
  }

  std::vector<float> target, value, rate;
};

class FollowJobOnEachRow : public EachSimdRow {};
YURAGI_ON_EACH_ROW(FollowJobOnEachRow);

TEST_P(FollowJobOnEachRow, ComputesTheSameBitsAsTheBaseRow) {
  Followers expected(37);
  Followers followers(37);
  for (std::uint64_t tick = 0; tick < 50; ++tick) {
    expected.jump(tick);
    followers.jump(tick);
    FollowJob base = expected.job();
    base.row = SimdRow::kX86_64;
    base.run();
    FollowJob job = followers.job();
    job.row = GetParam();
    EXPECT_EQ(job.run(), FollowJob::Problem::kNone);
  }
  EXPECT_EQ(bits_of(followers.value), bits_of(expected.value));
  EXPECT_EQ(bits_of(followers.rate), bits_of(expected.rate));
}

TEST_P(FollowJobOnEachRow, FollowsAsCriticallyDampedDoes) {
  Followers followers(3);
  CriticallyDamped expected;
  for (std::uint64_t tick = 0; tick < 200; ++tick) {
    if (tick % 20 == 0) followers.jump(tick);
    FollowJob job = followers.job();
    job.row = GetParam();
    job.run();
    expected.step(static_cast<double>(followers.target[1]), 9.0, kFollowTick_s);
    EXPECT_NEAR(followers.value[1], expected.value, 1e-5);
  }
}

TEST_P(FollowJobOnEachRow, NoTargetMovesItFasterThanItsBoundOrBeyondItself) {
  // The worst target is reversed as soon as the value comes near it.
  Followers followers(1);
  float largest_step = 0.0F;
  for (int tick = 0; tick < 2000; ++tick) {
    followers.target[0] = tick / (1 + tick / 100) % 2 == 0 ? 1.0F : -1.0F;
    const float before = followers.value[0];
    FollowJob job = followers.job();
    job.row = GetParam();
    job.run();
    largest_step = std::max(largest_step, std::abs(followers.value[0] - before));
    EXPECT_LE(std::abs(followers.value[0]), 1.0F + 1e-6F);
  }
  const double bound = 2.0 * 9.0 / std::numbers::e * kFollowTick_s;
  EXPECT_LE(largest_step, bound + 1e-6);
  EXPECT_GT(largest_step, 0.4 * bound);
}

TEST(FollowJobTest, ComesToRestAtZeroAndStaysThere) {
  Followers followers(4);
  followers.jump(1);
  for (int tick = 0; tick < 60; ++tick) followers.job().run();
  followers.target.assign(4, 0.0F);
  for (int tick = 0; tick < 300; ++tick) followers.job().run();
  EXPECT_EQ(followers.value, std::vector<float>(4, 0.0F));
  EXPECT_EQ(followers.rate, std::vector<float>(4, 0.0F));
}

TEST(FollowJobTest, ALongStepArrives) {
  Followers followers(1);
  followers.target[0] = 0.5F;
  followers.job(1e6).run();
  EXPECT_EQ(followers.value[0], 0.5F);
}

TEST(FollowJobTest, SaysWhatIsWrongAndThenDoesNothing) {
  Followers followers(5);
  followers.jump(1);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const double dt_s : {0.0, -1.0, nan}) EXPECT_EQ(followers.job(dt_s).run(), FollowJob::Problem::kStepNotPositive);
  for (const double omega_rad_s : {0.0, -1.0, nan}) {
    FollowJob job = followers.job();
    job.omega_rad_s = omega_rad_s;
    EXPECT_EQ(job.run(), FollowJob::Problem::kOmega);
  }
  FollowJob job = followers.job();
  job.rate_per_s = job.rate_per_s.first(4);
  EXPECT_EQ(job.run(), FollowJob::Problem::kSizesDiffer);
  EXPECT_EQ(followers.value, std::vector<float>(5, 0.0F));
}

}  // namespace
}  // namespace yuragi
