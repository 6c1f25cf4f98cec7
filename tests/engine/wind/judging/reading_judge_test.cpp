#include "engine/wind/judging/reading_judge.hpp"

#include <cmath>
#include <optional>
#include <random>

#include <gtest/gtest.h>

#include "engine/wind/turbulence/synthetic_wind.hpp"

namespace yuragi::wind::judging {
namespace {

/// A judge, and a sensor that speaks once in `interval_s`.
class Court {
 public:
  explicit Court(double interval_s = 1.0) : interval_s_(interval_s) {}

  bool judge_next(double speed_m_s, std::optional<double> direction_deg = 270.0,
                  std::optional<double> others_m_s = {}) {
    now_s_ += interval_s_;
    Reading reading;
    reading.time.mono = MonoTime(from_seconds(now_s_));
    reading.speed_m_s = speed_m_s;
    reading.direction_deg = direction_deg;
    return judge_.judge(reading, others_m_s);
  }
  /// A wind that is never twice the same.
  void breeze(int readings, double mean_m_s = 6.0) {
    for (int i = 0; i < readings; ++i)
      judge_next(mean_m_s + 0.8 * std::sin(1.7 * now_s_) + 0.3 * std::sin(5.1 * now_s_));
  }
  void be_silent(double duration_s) { now_s_ += duration_s; }
  void count_impossible(std::uint64_t readings) { judge_.count_impossible(readings); }
  const ReadingJudge& judge() const { return judge_; }

 private:
  double interval_s_;
  double now_s_ = 1000.0;
  ReadingJudge judge_;
};

TEST(ReadingJudge, BelievesEveryReadingOfATurbulentWind) {
  for (const double interval_s : {0.1, 1.0, 14.0, 48.0}) {
    turbulence::SyntheticWind wind({.mean_speed_m_s = 9.0, .turbulence_intensity = 0.3, .seed = 4});
    ReadingJudge judge;
    int refused = 0;
    for (int i = 0; i < 4000; ++i) {
      const Vector now = wind.at(interval_s * i);
      Reading reading;
      reading.time.mono = MonoTime(from_seconds(1.0 + interval_s * i));
      reading.speed_m_s = std::round(10.0 * speed_of(now)) / 10.0;
      reading.direction_deg = direction_from_deg(now);
      refused += judge.judge(reading) ? 0 : 1;
    }
    EXPECT_LE(refused, 8) << interval_s;
    EXPECT_EQ(judge.fault(), ReadingFault::kNone);
  }
}

TEST(ReadingJudge, HoldsASpikeBackAndCountsIt) {
  Court court;
  court.breeze(20);
  EXPECT_FALSE(court.judge_next(40.0));
  EXPECT_EQ(court.judge().fault(), ReadingFault::kSpike);
  EXPECT_TRUE(court.judge_next(6.1));
  EXPECT_EQ(court.judge().fault(), ReadingFault::kNone);
  EXPECT_EQ(court.judge().spikes(), 1U);
}

TEST(ReadingJudge, BelievesAStepThatStays) {
  Court court;
  court.breeze(20);
  EXPECT_FALSE(court.judge_next(17.0)) << "11 m/s in a second: 2.2 s at 5 m/s^2";
  EXPECT_FALSE(court.judge_next(17.3));
  EXPECT_FALSE(court.judge_next(16.8));
  EXPECT_TRUE(court.judge_next(17.1));
  EXPECT_TRUE(court.judge_next(16.2));
  EXPECT_EQ(court.judge().spikes(), 0U);
}

TEST(ReadingJudge, ATurnOfTheWindIsNoSpikeButADirectionFromNowhereIs) {
  Court court;
  for (int i = 0; i < 40; ++i) EXPECT_TRUE(court.judge_next(6.0 + 0.1 * (i % 7), std::fmod(340.0 + i, 360.0))) << i;
  EXPECT_FALSE(court.judge_next(6.2, 200.0));
  EXPECT_TRUE(court.judge_next(6.2, 21.0));
}

TEST(ReadingJudge, FindsAFrozenSensorAndTrustsItAgainWhenItMoves) {
  Court court;
  court.breeze(20);
  int believed = 0;
  for (int i = 0; i < 60; ++i) believed += court.judge_next(6.2) ? 1 : 0;
  EXPECT_NEAR(believed, 30, 2);
  EXPECT_EQ(court.judge().fault(), ReadingFault::kFrozen);
  EXPECT_TRUE(court.judge_next(6.3));
  EXPECT_EQ(court.judge().fault(), ReadingFault::kNone);
}

TEST(ReadingJudge, ACalmIsNotFrozenAndACoarseSensorMayRepeatItself) {
  Court calm;
  for (int i = 0; i < 1000; ++i) EXPECT_TRUE(calm.judge_next(0.0));
  Court coarse;
  for (int i = 0; i < 20; ++i) coarse.judge_next(i % 2 == 0 ? 3.0 : 4.0);  // whole m/s
  for (int i = 0; i < 150; ++i) EXPECT_TRUE(coarse.judge_next(3.0)) << i;
}

TEST(ReadingJudge, ASensorThatIsAskedMoreOftenThanItMeasuresIsNotFrozen) {
  Court court(1.0);
  for (int measured = 0; measured < 60; ++measured) {
    // A station that measures once in 48 s, asked each second.
    for (int i = 0; i < 48; ++i) EXPECT_TRUE(court.judge_next(5.0 + 0.1 * (measured * 7 % 11))) << measured;
  }
  for (int i = 0; i < 900; ++i) court.judge_next(5.0);
  EXPECT_EQ(court.judge().fault(), ReadingFault::kFrozen) << "ten times as long";
}

TEST(ReadingJudge, AWindThatIsSteadyFromTheFirstReadingOnHasTimeButNotForEver) {
  Court court(1.0);
  for (int i = 0; i < 550; ++i) EXPECT_TRUE(court.judge_next(5.0)) << i;
  for (int i = 0; i < 60; ++i) court.judge_next(5.0);
  EXPECT_EQ(court.judge().fault(), ReadingFault::kFrozen);
  EXPECT_NEAR(court.judge().same_for_s(), 609.0, 1e-6);
  EXPECT_EQ(court.judge().same_count(), 610U);
}

TEST(ReadingJudge, TheSameValueBeforeAndAfterALongSilenceIsNoFreeze) {
  Court court;
  court.breeze(60);
  for (int i = 0; i < 15; ++i) court.judge_next(6.2);
  court.be_silent(4000.0);
  for (int i = 0; i < 25; ++i) EXPECT_TRUE(court.judge_next(6.2)) << i;
}

TEST(ReadingJudge, AGustThatMovesShowsThatTheSensorLives) {
  ReadingJudge judge;
  for (int i = 0; i < 2000; ++i) {
    Reading reading;
    reading.time.mono = MonoTime(from_seconds(1000.0 + i));
    reading.speed_m_s = 5.0;  // a mean of ten minutes, say
    reading.gust_m_s = 6.0 + 0.1 * (i % 9);
    EXPECT_TRUE(judge.judge(reading)) << i;
  }
}

TEST(ReadingJudge, GivesUpASensorThatSpikesAgainAndAgainUntilItSpeaksSenseForAWhile) {
  Court court;
  court.breeze(20);
  for (int i = 0; i < 20; ++i) {
    court.breeze(1);
    court.judge_next(45.0 + 3.0 * (i % 5), 90.0);
  }
  court.breeze(1);
  EXPECT_EQ(court.judge().fault(), ReadingFault::kImplausible);
  EXPECT_GT(court.judge().bad_share(), 0.3);
  court.breeze(20);
  EXPECT_EQ(court.judge().fault(), ReadingFault::kImplausible) << "not yet";
  court.breeze(40);
  EXPECT_EQ(court.judge().fault(), ReadingFault::kNone);
}

TEST(ReadingJudge, ReadingsThatWereRefusedForWhatTheySaidSpeakAgainstTheSensorToo) {
  Court court;
  court.breeze(20);
  court.count_impossible(3);
  EXPECT_EQ(court.judge().fault(), ReadingFault::kNone) << "it happens";
  court.count_impossible(1'000'000'000'000);
  EXPECT_EQ(court.judge().fault(), ReadingFault::kImplausible);
  court.breeze(100);
  EXPECT_EQ(court.judge().fault(), ReadingFault::kNone) << "all the same";
}

TEST(ReadingJudge, WhatIsBeyondTheSensorsRangeIsNotBelieved) {
  ReadingJudge judge({.max_speed_m_s = 30.0});
  Reading reading;
  reading.speed_m_s = 31.0;
  EXPECT_FALSE(judge.judge(reading));
  reading.speed_m_s = 29.0;
  EXPECT_TRUE(judge.judge(reading));
}

TEST(ReadingJudge, RandomNumbersFromEverywhereAreNoWind) {
  std::mt19937_64 random(5);
  Court court;
  int believed = 0;
  for (int i = 0; i < 2000; ++i) {
    believed +=
        court.judge_next(static_cast<double>(random() % 600) / 10.0, static_cast<double>(random() % 360)) ? 1 : 0;
  }
  EXPECT_LT(believed, 200);
  EXPECT_EQ(court.judge().fault(), ReadingFault::kImplausible);
}

TEST(ReadingJudge, AStepOfAFastRecordingIsBelievedAfterTwentyReadings) {
  Court court(0.01);  // a reading a second, played a hundred times too fast
  court.breeze(20);
  int held_back = 0;
  while (held_back < 100 && !court.judge_next(17.0 + 0.1 * (held_back % 5))) ++held_back;
  EXPECT_EQ(held_back, 19);
  EXPECT_EQ(court.judge().spikes(), 0U);
}

TEST(ReadingJudge, ACalmOfTheOthersEndsNoSeizureAndASilenceIsNone) {
  Court court(60.0);
  court.breeze(20);
  for (int i = 0; i < 130; ++i) court.judge_next(0.0, 270.0, 6.0);
  EXPECT_EQ(court.judge().fault(), ReadingFault::kSeized);
  EXPECT_FALSE(court.judge_next(0.0, 270.0, 1.0));
  EXPECT_TRUE(court.judge_next(1.5, 270.0, 1.0)) << "it turns";

  Court silent(86400.0);  // one reading a day
  silent.breeze(5);
  for (int i = 0; i < 5; ++i) EXPECT_TRUE(silent.judge_next(0.0)) << i;
}

TEST(ReadingJudge, FindsASeizedCupWhereOthersSayThatItIsWindy) {
  Court court(10.0);
  court.breeze(20);
  int believed = 0;
  for (int i = 0; i < 1000; ++i) believed += court.judge_next(0.0, 270.0, 6.0) ? 1 : 0;
  EXPECT_NEAR(believed, 720, 3) << "two hours of readings in 10 s each";
  EXPECT_EQ(court.judge().fault(), ReadingFault::kSeized);
  EXPECT_TRUE(court.judge_next(5.5));

  Court night(10.0);  // alone, after a windy day
  night.breeze(20);
  for (int i = 0; i < 3000; ++i) EXPECT_TRUE(night.judge_next(0.0)) << i;
}

TEST(ReadingJudge, IsNotConfusedByTimesAndNumbersOfAnyKind) {
  std::mt19937_64 random(3);
  ReadingJudge judge;
  for (int i = 0; i < 20000; ++i) {
    Reading reading;
    reading.time.mono = MonoTime(from_seconds(1e4 + static_cast<double>(random() % 20000)));
    reading.speed_m_s = static_cast<double>(random() % 121);
    if (random() % 2 == 0) reading.direction_deg = static_cast<double>(random() % 360);
    judge.judge(reading);
    ASSERT_LT(static_cast<std::size_t>(judge.fault()), kReadingFaultNames.size());
  }
}

}  // namespace
}  // namespace yuragi::wind::judging
