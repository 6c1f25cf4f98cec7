#include "engine/wind/judging/group_gains.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <vector>

#include <gtest/gtest.h>

namespace yuragi::wind::judging {
namespace {

using Learnt = GroupGains::Learnt;

/// Sensors whose five-minute means are told once a second, and what is learnt of them.
class Group {
 public:
  explicit Group(std::size_t count) : gains_(count), members_(count, GroupGains::Member{.is_in = true}) {}

  void leaves(std::size_t sensor) { members_[sensor].is_in = false; }
  void returns(std::size_t sensor) { members_[sensor].is_in = true; }

  /// So many minutes of a wind that swells and sinks, read so many times too high by each.
  void minutes(double duration_min, const std::vector<double>& factors, double wind_m_s = 6.0) {
    for (double left_s = 60.0 * duration_min; left_s > 0.0; left_s -= 1.0) {
      now_s_ += 1.0;
      const double wind = wind_m_s * (1.0 + 0.2 * std::sin(0.003 * now_s_));
      for (std::size_t i = 0; i < members_.size(); ++i) members_[i].mean_m_s = factors[i] * wind;
      gains_.advance(MonoTime(from_seconds(now_s_)), members_);
    }
  }

  /// What the sensors that are in say together after levelling.
  double level_m_s() const {
    double sum_ln = 0.0;
    double count = 0.0;
    for (std::size_t i = 0; i < members_.size(); ++i) {
      if (!members_[i].is_in) continue;
      sum_ln += std::log(gains_.gain(i) * members_[i].mean_m_s);
      count += 1.0;
    }
    return std::exp(sum_ln / count);
  }
  double sum() const {
    return std::accumulate(gains_.learnt().begin(), gains_.learnt().end(), 0.0,
                           [](double sum, const Learnt& learnt) { return sum + learnt.deviation; });
  }
  GroupGains& gains() { return gains_; }

 private:
  GroupGains gains_;
  std::vector<GroupGains::Member> members_;
  double now_s_ = 5000.0;
};

TEST(GroupGains, TwoThatDifferAreLevelledToTheirCommonMean) {
  Group places(2);
  EXPECT_EQ(places.gains().gain(0), 1.0);
  places.minutes(55, {1.5, 1.0});
  const double apart = 1.5 * places.gains().gain(0) / places.gains().gain(1);
  EXPECT_GT(apart, 1.0);
  EXPECT_LT(apart, 1.05) << "a tenth of the difference is left after 55 minutes";
  EXPECT_NEAR(places.gains().gain(0) * places.gains().gain(1), 1.0, 1e-12);
  places.minutes(240, {1.5, 1.0});
  EXPECT_NEAR(places.gains().reads_times_group(0), std::sqrt(1.5), 0.01);
  EXPECT_NEAR(places.gains().reads_times_group(1), 1.0 / std::sqrt(1.5), 0.01);
  EXPECT_FALSE(places.gains().is_at_bound(0));
}

TEST(GroupGains, TheMeanOfTheGroupStaysWhatItWas) {
  Group roofs(3);
  roofs.minutes(1.0 / 60.0, {1.3, 1.0, 0.9});
  for (int hour = 0; hour < 5; ++hour) {
    roofs.minutes(60, {1.3, 1.0, 0.9});
    EXPECT_NEAR(roofs.sum(), 0.0, 1e-12);
  }
  const double group = std::cbrt(1.3 * 0.9);
  EXPECT_NEAR(roofs.gains().reads_times_group(0), 1.3 / group, 0.01);
  EXPECT_NEAR(roofs.gains().reads_times_group(2), 0.9 / group, 0.01);
}

TEST(GroupGains, WhatIsLearntAtOnceIsTooSmallToBeSeen) {
  Group places(2);
  double largest = 0.0;
  double before = places.gains().gain(0);
  for (int second = 0; second < 3600; ++second) {
    places.minutes(1.0 / 60.0, {3.0, 0.8});
    largest = std::max(largest, std::abs(places.gains().gain(0) - before));
    before = places.gains().gain(0);
  }
  EXPECT_LT(largest, 0.001) << "per second";
}

TEST(GroupGains, OneThatReadsThreeTimesTooHighIsLevelledToTheBoundAndNoFurther) {
  Group two(2);
  two.minutes(600, {3.0, 1.0});
  EXPECT_NEAR(two.gains().reads_times_group(0), 1.5, 1e-9);
  EXPECT_LE(two.gains().reads_times_group(0), 1.5 + 1e-12);
  EXPECT_NEAR(two.sum(), 0.0, 1e-12);
  EXPECT_TRUE(two.gains().is_at_bound(0));

  Group three(3);
  three.minutes(600, {3.0, 1.0, 1.0});
  EXPECT_LE(three.gains().reads_times_group(0), 1.5 + 1e-12);
  EXPECT_NEAR(three.sum(), 0.0, 1e-12);
  three.minutes(600, {1.0, 1.0, 1.0});
  EXPECT_LT(three.gains().reads_times_group(0), 1.1) << "it comes back";
}

TEST(GroupGains, NothingIsLearntOfOneSensorNorInACalm) {
  Group alone(2);
  alone.leaves(1);
  alone.minutes(600, {1.5, 1.0});
  EXPECT_EQ(alone.gains().gain(0), 1.0);
  Group calm(2);
  calm.minutes(600, {1.5, 1.0}, 1.2);
  EXPECT_EQ(calm.gains().gain(0), 1.0);
  calm.minutes(60, {1.0, 0.0});
  EXPECT_EQ(calm.gains().gain(0), 1.0) << "one has no wind at all";
}

TEST(GroupGains, OneThatIsOutKeepsWhatIsKnownOfItAndItsGoingAndComingIsNotSeen) {
  Group roofs(3);
  roofs.minutes(1200, {1.3, 1.0, 0.9});
  const double gain = roofs.gains().gain(0);
  const double all_m_s = roofs.level_m_s();
  roofs.leaves(0);
  EXPECT_NEAR(roofs.level_m_s(), all_m_s, 0.002 * all_m_s);
  roofs.minutes(120, {25.0, 1.0, 0.9});
  EXPECT_EQ(roofs.gains().gain(0), gain);
  EXPECT_NEAR(roofs.gains().gain(1), std::cbrt(1.3 * 0.9), 0.01);
  roofs.minutes(1.0 / 60.0, {1.3, 1.0, 0.9});
  const double without_m_s = roofs.level_m_s();
  roofs.returns(0);
  EXPECT_NEAR(roofs.level_m_s(), without_m_s, 0.002 * without_m_s);
  EXPECT_NEAR(roofs.sum(), 0.0, 1e-12);
}

TEST(GroupGains, ANewCalibrationIsLearntAsFastAsTheFirst) {
  Group places(2);
  places.minutes(600, {1.4, 1.0});
  const double before = places.gains().gain(0);
  places.gains().relearn(0);
  EXPECT_EQ(places.gains().gain(0), before) << "no jump";
  places.minutes(55, {1.0, 1.0});
  EXPECT_NEAR(places.gains().gain(0), 1.0, 0.03);
}

TEST(GroupGains, ARestartGoesOn) {
  Group places(2);
  places.minutes(120, {1.4, 1.0});
  GroupGains next(2);
  ASSERT_TRUE(next.restore(places.gains().learnt()));
  EXPECT_NEAR(next.gain(0), places.gains().gain(0), 1e-12);
  EXPECT_EQ(next.learnt()[1].learnt_s, places.gains().learnt()[1].learnt_s);
}

TEST(GroupGains, OfThoseThatAreStillThereTheMeanIsOne) {
  GroupGains gains(3);
  ASSERT_TRUE(gains.restore(std::vector<Learnt>{{0.3, 7200.0}, {0.1, 7200.0}, {}}));
  EXPECT_NEAR(gains.learnt()[0].deviation, 0.1, 1e-12);
  EXPECT_NEAR(gains.learnt()[1].deviation, -0.1, 1e-12);
  EXPECT_EQ(gains.gain(2), 1.0) << "nothing is known of it";
  GroupGains alone(1);
  ASSERT_TRUE(alone.restore(std::vector<Learnt>{{0.3, 7200.0}}));
  EXPECT_EQ(alone.gain(0), 1.0);
}

TEST(GroupGains, WhatCannotHaveBeenLearntIsRefused) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  GroupGains gains(2);
  const std::vector<Learnt> good{{0.2, 7200.0}, {-0.2, 7200.0}};
  ASSERT_TRUE(gains.restore(good));
  for (const Learnt& bad : {Learnt{kNan, 1.0}, Learnt{kInfinity, 1.0}, Learnt{0.5, 1.0}, Learnt{-20.0, 1.0},
                            Learnt{0.1, kNan}, Learnt{0.1, -1.0}, Learnt{0.1, kInfinity}}) {
    EXPECT_FALSE(gains.restore(std::vector<Learnt>{good[0], bad})) << bad.deviation << " " << bad.learnt_s;
  }
  EXPECT_FALSE(gains.restore(std::vector<Learnt>{good[0]})) << "of another number of sensors";
  EXPECT_NEAR(gains.learnt()[0].deviation, 0.2, 1e-12) << "nothing has changed";
  GroupGains three(3);
  EXPECT_FALSE(three.restore(std::vector<Learnt>{{0.4, 9.0}, {-0.4, 9.0}, {-0.4, 9.0}})) << "past the bound, centred";
  ASSERT_TRUE(gains.restore(std::vector<Learnt>{{0.1, 1e9}, {-0.1, 1e9}}));
  EXPECT_EQ(gains.learnt()[0].learnt_s, GroupGainsSettings{}.memory_s) << "more counts for no more";
}

}  // namespace
}  // namespace yuragi::wind::judging
