#include "engine/wind/judging/sensor_vote.hpp"

#include <cmath>
#include <initializer_list>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace yuragi::wind::judging {
namespace {

/// Sensors that speak every ten seconds, and their vote.
class Assembly {
 public:
  explicit Assembly(std::size_t count) : vote_(count) {
    for (std::size_t i = 0; i < count; ++i) vote_.set_comparable(i, true);
  }

  /// So many minutes in which they say these means; a negative one says nothing.
  void minutes(double duration_min, std::initializer_list<double> means_m_s) {
    for (double left_s = 60.0 * duration_min; left_s > 0.0; left_s -= kStep_s) {
      now_s_ += kStep_s;
      const MonoTime now(from_seconds(now_s_));
      std::size_t sensor = 0;
      for (const double mean_m_s : means_m_s) {
        const double gust = 1.0 + 0.3 * std::sin(0.1 * now_s_ + static_cast<double>(sensor));
        if (mean_m_s >= 0.0) vote_.accept(sensor, now, gust * mean_m_s);
        ++sensor;
      }
      vote_.advance(now);
    }
  }
  Vote on(std::size_t sensor) const { return vote_.vote_on(sensor); }
  SensorVote& vote() { return vote_; }

 private:
  static constexpr double kStep_s = 10.0;
  double now_s_ = 5000.0;
  SensorVote vote_;
};

TEST(SensorVote, OneOfThreeThatDiffersForLongIsOutvotedAndHeardAgainWhenItAgrees) {
  Assembly roofs(3);
  roofs.minutes(13, {5.0, 5.5, 25.0});
  EXPECT_EQ(roofs.on(2), Vote::kNone) << "it may be a gust that the others do not feel";
  EXPECT_FALSE(roofs.vote().agrees(2)) << "but it does not agree now";
  EXPECT_TRUE(roofs.vote().agrees(0));
  roofs.minutes(4, {5.0, 5.5, 25.0});
  EXPECT_EQ(roofs.on(2), Vote::kOutvoted);
  EXPECT_EQ(roofs.on(0), Vote::kNone);
  EXPECT_EQ(roofs.on(1), Vote::kNone);
  EXPECT_NEAR(roofs.vote().mean_m_s(2), 25.0, 3.0);
  EXPECT_NEAR(roofs.vote().others_m_s(2).value_or(0.0), 5.0, 0.6);

  roofs.minutes(9, {5.0, 5.5, 6.0});
  EXPECT_EQ(roofs.on(2), Vote::kOutvoted) << "its mean must come back, and stay";
  roofs.minutes(12, {5.0, 5.5, 6.0});
  EXPECT_EQ(roofs.on(2), Vote::kNone);
}

TEST(SensorVote, ASensorThatStandsStillWhereTheOthersHaveWindIsOutvotedToo) {
  Assembly roofs(4);
  roofs.minutes(30, {8.0, 0.0, 7.0, 9.0});
  EXPECT_EQ(roofs.on(1), Vote::kOutvoted);
  EXPECT_EQ(roofs.on(0), Vote::kNone);
}

TEST(SensorVote, ACourtyardIsNotOutvotedByRoofs) {
  Assembly walls(3);
  walls.minutes(120, {8.0, 2.2, 9.0});
  for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(walls.on(i), Vote::kNone) << i;
}

TEST(SensorVote, TwoThatDifferAreDisputedAndNeitherIsCondemned) {
  Assembly pair(2);
  pair.minutes(30, {2.0, 20.0});
  EXPECT_EQ(pair.on(0), Vote::kDisputed);
  EXPECT_EQ(pair.on(1), Vote::kDisputed);
  pair.minutes(30, {2.0, 3.0});
  EXPECT_EQ(pair.on(0), Vote::kNone);
  EXPECT_EQ(pair.on(1), Vote::kNone);
}

TEST(SensorVote, WhereEachSaysSomethingElseNobodyIsCondemned) {
  Assembly three(3);
  three.minutes(60, {1.0, 12.0, 60.0});
  for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(three.on(i), Vote::kDisputed) << i;
  Assembly four(4);
  four.minutes(60, {2.0, 2.1, 20.0, 21.0});
  for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(four.on(i), Vote::kDisputed) << i;
}

TEST(SensorVote, ASentenceStandsWhileThereIsNoMajorityToChangeIt) {
  Assembly roofs(3);
  roofs.minutes(30, {5.0, 5.5, 40.0});
  ASSERT_EQ(roofs.on(2), Vote::kOutvoted);
  roofs.vote().set_comparable(0, false);
  roofs.minutes(60, {5.0, 5.5, 40.0});
  EXPECT_EQ(roofs.on(2), Vote::kOutvoted);
  roofs.vote().set_comparable(1, false);
  roofs.minutes(60, {5.0, 5.5, 5.5});
  EXPECT_EQ(roofs.on(2), Vote::kOutvoted) << "nobody can acquit it";
  EXPECT_FALSE(roofs.vote().others_m_s(2).has_value());
  roofs.vote().set_comparable(0, true);
  roofs.vote().set_comparable(1, true);
  roofs.minutes(30, {5.0, 5.5, 5.5});
  EXPECT_EQ(roofs.on(2), Vote::kNone);
}

TEST(SensorVote, ADisputeEndsWithTheOtherSensor) {
  Assembly pair(2);
  pair.minutes(30, {2.0, 20.0});
  ASSERT_EQ(pair.on(0), Vote::kDisputed);
  pair.vote().set_comparable(1, false);
  pair.minutes(15, {2.0, -1.0});
  EXPECT_EQ(pair.on(0), Vote::kNone);
}

TEST(SensorVote, ASensorThatHasJustBegunToSpeakAgainIsNotComparedAtOnce) {
  Assembly pair(2);
  pair.minutes(20, {5.0, 5.0});
  pair.minutes(20, {5.0, -1.0});
  pair.minutes(0.5, {5.0, 50.0});
  EXPECT_FALSE(pair.vote().others_m_s(0).has_value());
  pair.minutes(6, {5.0, 5.0});
  EXPECT_TRUE(pair.vote().others_m_s(0).has_value());
}

TEST(SensorVote, TimesOfAnyKindDoNotConfuseIt) {
  std::mt19937_64 random(11);
  SensorVote vote(3);
  for (int i = 0; i < 50000; ++i) {
    const std::size_t sensor = random() % 3;
    const double ten_years_s = 3.2e8;
    const double time_s = random() % 97 == 0 ? ten_years_s * static_cast<double>(random() % 3) : 1e4 + 0.5 * i;
    vote.set_comparable(sensor, random() % 50 != 0);
    vote.accept(sensor, MonoTime(from_seconds(time_s)), static_cast<double>(random() % 1200) / 10.0);
    vote.advance(MonoTime(from_seconds(random() % 89 == 0 ? time_s : 1e4 + 0.5 * i)));
    ASSERT_TRUE(vote.mean_m_s(sensor) >= 0.0 && vote.mean_m_s(sensor) <= 120.0) << i;
    const double others_m_s = vote.others_m_s(sensor).value_or(0.0);
    ASSERT_TRUE(others_m_s >= 0.0 && others_m_s <= 120.0) << i;
  }
}

}  // namespace
}  // namespace yuragi::wind::judging
