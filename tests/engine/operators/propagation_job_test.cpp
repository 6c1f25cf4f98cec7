#include "engine/operators/propagation_job.hpp"

#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "engine/math/philox.hpp"
#include "tests/support/bits.hpp"
#include "tests/support/each_simd_row.hpp"

namespace yuragi::operators {
namespace {

constexpr std::size_t kWidth = 19;
constexpr std::size_t kLinks = 31;
constexpr double kTravel_s = 0.8;

/// A history of smooth signals, and room for what comes of it.
struct Chain {
  explicit Chain(double ticks_per_s = 60.0)
      : dt_s(1.0 / ticks_per_s), history(kWidth, 2.0), base(kWidth, 0.0F), growth(kLinks, 1.0F), out(kWidth * kLinks) {}

  static double signal(double at_s, std::size_t i) {
    return std::sin(3.0 * at_s + static_cast<double>(i)) + 0.5 * std::sin(7.3 * at_s);
  }
  void go_on(int ticks) {
    std::vector<float> values(kWidth);
    for (int tick = 0; tick < ticks; ++tick) {
      now_s += dt_s;
      for (std::size_t i = 0; i < kWidth; ++i) values[i] = static_cast<float>(signal(now_s, i));
      history.push(values, dt_s);
    }
  }
  PropagationJob job() {
    return {.history = &history, .base = base, .growth = growth, .travel_time_s = kTravel_s, .out = out};
  }
  float at(std::size_t link, std::size_t i) const { return out[link * kWidth + i]; }

  double dt_s;
  double now_s = 0.0;
  PropagationHistory history;
  std::vector<float> base, growth, out;
};

class PropagationJobOnEachRow : public EachSimdRow {};
YURAGI_ON_EACH_ROW(PropagationJobOnEachRow);

TEST_P(PropagationJobOnEachRow, ComputesTheSameBitsAsTheBaseRow) {
  Chain expected;
  Chain chain;
  expected.go_on(100);
  chain.go_on(100);
  PropagationJob base = expected.job();
  base.row = kBaseSimdRow;
  EXPECT_EQ(base.run(), PropagationJob::Problem::kNone);
  PropagationJob job = chain.job();
  job.row = GetParam();
  EXPECT_EQ(job.run(), PropagationJob::Problem::kNone);
  EXPECT_EQ(bits_of(chain.out), bits_of(expected.out));
}

TEST(PropagationJobTest, EachLinkTakesTheValueOfItsDelayAgoAtAnyTickRate) {
  for (const double ticks_per_s : {24.0, 60.0, 61.7, 144.0, 1000.0}) {
    Chain chain(ticks_per_s);
    chain.go_on(static_cast<int>(3.0 * ticks_per_s));
    chain.job().run();
    for (std::size_t link = 0; link < kLinks; ++link) {
      const double ago_s = kTravel_s * static_cast<double>(link) / static_cast<double>(kLinks - 1);
      for (std::size_t i = 0; i < kWidth; ++i) {
        // What straight lines between the samples miss of the curve.
        EXPECT_NEAR(chain.at(link, i), Chain::signal(chain.now_s - ago_s, i), 0.012) << ticks_per_s << " Hz, " << link;
      }
    }
  }
}

TEST(PropagationJobTest, TheBaseIsForAllLinksAtOnceAndTheNoiseGrows) {
  Chain chain;
  chain.go_on(200);
  for (std::size_t link = 0; link < kLinks; ++link) chain.growth[link] = static_cast<float>(link) / (kLinks - 1);
  chain.base.assign(kWidth, 0.25F);
  chain.job().run();
  Chain plain;
  plain.go_on(200);
  plain.job().run();
  for (std::size_t link = 0; link < kLinks; ++link) {
    for (std::size_t i = 0; i < kWidth; ++i) {
      EXPECT_NEAR(chain.at(link, i), 0.25F + chain.growth[link] * plain.at(link, i), 1e-6F);
    }
  }
  for (std::size_t i = 0; i < kWidth; ++i) EXPECT_EQ(chain.at(0, i), 0.25F);  // the fixed edge has no noise
}

TEST(PropagationJobTest, ABandIsThoseRowsOfTheWhole) {
  Chain chain;
  chain.go_on(100);
  chain.job().run();
  std::vector<float> band(3 * kWidth);
  PropagationJob job = chain.job();
  job.first_link = 7;
  job.out = band;
  EXPECT_EQ(job.run(), PropagationJob::Problem::kNone);
  EXPECT_EQ(bits_of(band), bits_of(std::span(chain.out).subspan(7 * kWidth, 3 * kWidth)));
}

TEST(PropagationJobTest, WhatIsReadMovesNoFasterThanWhatIsWritten) {
  // Ticks of any length, a signal that always moves by as much as it may: 2 a second.
  const math::RandomStream random(5, math::stream_id("propagation job test"));
  PropagationHistory history(1, 1.0);
  const std::vector<float> base(1), growth(kLinks, 1.0F);
  std::vector<float> out(kLinks), before(kLinks);
  float value = 0.0F;
  for (std::uint64_t tick = 0; tick < 5000; ++tick) {
    const double dt_s = 0.05 * std::pow(random.uniform(2 * tick), 4.0) + 1e-5;
    value += static_cast<float>(random.uniform(2 * tick + 1) < 0.5 ? -2.0 * dt_s : 2.0 * dt_s);
    history.push(std::span(&value, 1), dt_s);
    PropagationJob{.history = &history, .base = base, .growth = growth, .travel_time_s = 0.6, .out = out}.run();
    for (std::size_t link = 0; link < kLinks; ++link) {
      ASSERT_LE(std::abs(out[link] - before[link]), 2.0 * dt_s * 1.001 + 1e-6) << tick << ", " << link;
    }
    before = out;
  }
}

TEST(PropagationJobTest, AChangeOfTheTravelTimeIsNoJump) {
  Chain chain;
  chain.go_on(200);
  PropagationJob job = chain.job();
  std::vector<float> before;
  for (int i = 0; i <= 1000; ++i) {
    job.travel_time_s = 0.4 + 0.001 * i;
    job.run();
    // 6.7 is the steepest that the signal is; the last link's delay changes by 1 ms.
    for (std::size_t at = 0; at < before.size(); ++at) ASSERT_NEAR(chain.out[at], before[at], 6.7e-3 * 1.01);
    before = chain.out;
  }
}

TEST(PropagationHistoryTest, AllHasBeenZeroForEverAtTheStart) {
  Chain chain;
  chain.job().run();
  EXPECT_EQ(chain.out, std::vector<float>(chain.out.size(), 0.0F));
  chain.go_on(6);  // 0.1 s
  chain.job().run();
  EXPECT_NE(chain.at(1, 0), 0.0F);
  EXPECT_EQ(chain.at(kLinks - 1, 0), 0.0F);
}

TEST(PropagationHistoryTest, APauseLongerThanItRemembersAndNoTimeAtAllDoNoHarm) {
  PropagationHistory history(1, 1.0);
  float value = 1.0F;
  history.push(std::span(&value, 1), 1.0);
  value = 3.0F;
  history.push(std::span(&value, 1), 1e9);
  const PropagationHistory::Between now = history.at(0.0);
  EXPECT_NEAR(*now.newer, 3.0F, 1e-6F);
  const PropagationHistory::Between past = history.at(1.0);
  EXPECT_NEAR(*past.newer, 3.0F, 1e-5F);
  EXPECT_NEAR(*past.older, 3.0F, 1e-5F);
  value = 9.0F;
  history.push(std::span(&value, 1), 0.0);
  history.push(std::span(&value, 1), -1.0);
  EXPECT_NEAR(*history.at(0.0).newer, 3.0F, 1e-6F);
}

TEST(PropagationJobTest, SaysWhatIsWrongAndThenDoesNothing) {
  using Problem = PropagationJob::Problem;
  Chain chain;
  chain.go_on(10);
  PropagationJob job = chain.job();
  job.history = nullptr;
  EXPECT_EQ(job.run(), Problem::kNoHistory);
  for (const double travel_s : {-1.0, std::numeric_limits<double>::infinity()}) {
    job = chain.job();
    job.travel_time_s = travel_s;
    EXPECT_EQ(job.run(), Problem::kTravelTime);
  }
  job = chain.job();
  job.base = job.base.first(kWidth - 1);
  EXPECT_EQ(job.run(), Problem::kSizesDiffer);
  job = chain.job();
  job.out = job.out.first(kWidth + 1);
  EXPECT_EQ(job.run(), Problem::kSizesDiffer);
  job = chain.job();
  job.first_link = 1;
  EXPECT_EQ(job.run(), Problem::kNotALink);
  EXPECT_EQ(chain.out, std::vector<float>(chain.out.size(), 0.0F));
}

}  // namespace
}  // namespace yuragi::operators
