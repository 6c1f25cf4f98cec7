#include "viewer/pace/pace_keeper.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <optional>
#include <vector>

#include <gtest/gtest.h>

namespace yuragi::viewer::pace {
namespace {

constexpr double kRefresh_s = 1.0 / 60.0;
constexpr double kHour_s = Keeper::kHour_s;
const Ladder kLadder(look::Quality::kAuto, kRefresh_s);

/// A machine that needs so long for all of a picture in quality high, of which a part is the same however little is
/// drawn.
struct Machine {
  double full_s;
  double fixed = 0.15;
  double work_s(const Step& step, const DrawnPart& part) const {
    const double quality = step.quality == look::Quality::kHigh     ? 1.0
                           : step.quality == look::Quality::kMedium ? 0.58
                                                                    : 0.35;
    const auto side = static_cast<double>(part.side);
    return full_s * quality * (fixed + (1.0 - fixed) * (0.6 * side * side + 0.4 * static_cast<double>(part.blades)));
  }
};

struct Change {
  double at_s;
  Step step;
};

/// What it does in so long a time on a machine that may be another from moment to moment.
std::vector<Change> run_for(Keeper& keeper, double time_s, const std::function<Machine(double)>& machine_at) {
  std::vector<Change> changes;
  for (double now_s = 0.0; now_s < time_s;) {
    const Step before = keeper.step();
    const double work_s = machine_at(now_s).work_s(before, keeper.drawn());
    const double passed_s = std::max(work_s, keeper.picture_s());
    keeper.advance(passed_s, work_s);
    now_s += passed_s;
    if (keeper.step() != before) changes.push_back({.at_s = now_s, .step = keeper.step()});
  }
  return changes;
}

double work_s(const Keeper& keeper, const Machine& machine) {
  return machine.work_s(keeper.step(), keeper.step().part);
}

TEST(PaceLadderTest, GivesUpPicturesFirstThenQualityThenPixels) {
  ASSERT_EQ(kLadder.size(), 8U);
  EXPECT_EQ(kLadder[0], (Step{.quality = look::Quality::kHigh}));
  EXPECT_EQ(kLadder[1], (Step{.quality = look::Quality::kHigh, .refreshes = 2}));
  EXPECT_EQ(kLadder[2], (Step{.quality = look::Quality::kMedium, .refreshes = 2}));
  EXPECT_EQ(kLadder[3], (Step{.quality = look::Quality::kLow, .refreshes = 2}));
  EXPECT_EQ(kLadder[7], (Step{.quality = look::Quality::kLow, .part = Ladder::kParts[3], .refreshes = 2}));
}

TEST(PaceLadderTest, HasTheDisplaysRateOrAnEvenPartOfIt) {
  for (const double rate_hz : {24.0, 25.0, 30.0, 50.0, 60.0, 75.0, 100.0, 120.0, 144.0, 240.0, 360.0}) {
    const Ladder ladder(look::Quality::kAuto, 1.0 / rate_hz);
    for (std::size_t i = 0; i < ladder.size(); ++i) {
      EXPECT_GE(1.0 / ladder.picture_s(i), 23.9) << rate_hz;
      EXPECT_GE(ladder[i].refreshes, i == 0 ? 1 : ladder[i - 1].refreshes);
    }
    EXPECT_LT(1.0 / ladder.picture_s(ladder.size() - 1), 50.0) << rate_hz;
    EXPECT_EQ(ladder[0].refreshes, 1);
  }
  for (const double refresh_s : {0.0, -1.0, 1e9}) {  // what a driver may say
    EXPECT_LE(Ladder(look::Quality::kAuto, refresh_s).size(), 12U);
  }
}

TEST(PaceLadderTest, AQualityThatSomebodyHasChosenStays) {
  for (const look::Quality quality : {look::Quality::kHigh, look::Quality::kMedium, look::Quality::kLow}) {
    const Ladder ladder(quality, kRefresh_s);
    EXPECT_EQ(ladder.size(), quality == look::Quality::kLow ? 6U : 2U);
    for (std::size_t i = 0; i < ladder.size(); ++i) EXPECT_EQ(ladder[i].quality, quality);
  }
}

TEST(PaceKeeperTest, DrawsEverythingWhereThatIsQuickEnough) {
  Keeper keeper(kLadder, 0);
  EXPECT_TRUE(run_for(keeper, 600.0, [](double) { return Machine{0.016}; }).empty());
  EXPECT_EQ(keeper.step(), kLadder[0]);
  EXPECT_EQ(keeper.drawn(), DrawnPart{});
}

TEST(PaceKeeperTest, HoldsThePaceOnMachinesOfManySpeedsAndStaysThere) {
  for (int i = 0; i < 31; ++i) {
    const double full_s = 0.010 * std::pow(1.1, i);  // to 0.17
    Keeper keeper(kLadder, 0);
    const Machine machine{full_s};
    const auto same = [&](double) { return machine; };
    run_for(keeper, Keeper::kSettling_s, same);
    EXPECT_LE(work_s(keeper, machine), 1.05 * keeper.picture_s()) << full_s;
    // What it has measured, it knows: it does not go to and fro.
    EXPECT_LE(run_for(keeper, 1.5 * kHour_s, same).size(), 2U) << full_s;
    EXPECT_LE(work_s(keeper, machine), 1.05 * keeper.picture_s()) << full_s;
    // Nor has it given up what fits easily.
    std::size_t step = 0;
    while (kLadder[step] != keeper.step()) ++step;
    if (step == 0) continue;
    EXPECT_GT(machine.work_s(kLadder[step - 1], kLadder[step - 1].part), 0.65 * kLadder.picture_s(step - 1)) << full_s;
  }
}

TEST(PaceKeeperTest, KnowsAVerySlowMachineWithinSeconds) {
  Keeper keeper(kLadder, 0);
  const std::vector<Change> changes = run_for(keeper, 20.0, [](double) { return Machine{0.9}; });
  ASSERT_FALSE(changes.empty());
  EXPECT_LE(changes.front().at_s, 3.9 + 0.9);  // it has had a few pictures
  EXPECT_EQ(keeper.step(), kLadder[kLadder.size() - 1]);
}

TEST(PaceKeeperTest, GivesNothingUpThatSavesNothing) {
  for (const double work_s : {0.040, 0.060, 0.300}) {
    Keeper keeper(kLadder, 0);
    for (int picture = 0; picture * work_s < 2.0 * kHour_s; ++picture) {
      keeper.advance(work_s, work_s);
      if (picture * work_s > Keeper::kSettling_s) {
        ASSERT_EQ(keeper.step(), kLadder[1]) << picture * work_s;
      }
    }
  }
  // Where only what is below quality low saves nothing, it is drawn in that.
  Keeper keeper(kLadder, 3);
  const auto machine = [](double) { return Machine{.full_s = 0.12, .fixed = 1.0}; };
  run_for(keeper, Keeper::kSettling_s, machine);
  EXPECT_EQ(keeper.step(), kLadder[3]);
  EXPECT_TRUE(run_for(keeper, 2.0 * kHour_s, machine).empty());
}

TEST(PaceKeeperTest, DoesNotJudgeWhatADriverPreparesAtFirstUse) {
  Keeper keeper(kLadder, 0);
  const std::vector<Change> changes =
      run_for(keeper, 60.0, [](double now_s) { return Machine{now_s < 0.9 ? 0.07 : 0.014}; });
  EXPECT_TRUE(changes.empty());
}

TEST(PaceKeeperTest, ALoadOfASecondChangesNothing) {
  Keeper keeper(kLadder, 1);
  const auto machine = [](double now_s) { return Machine{std::fmod(now_s, 12.0) < 1.3 ? 0.037 : 0.025}; };
  EXPECT_TRUE(run_for(keeper, 300.0, machine).empty());
}

TEST(PaceKeeperTest, ASlowPictureNowAndThenChangesNothing) {
  Keeper keeper(kLadder, 0);
  int picture = 0;
  for (int i = 0; i < 20000; ++i) {
    keeper.advance(kRefresh_s, ++picture % 20 == 0 ? 0.2 : 0.012);
    ASSERT_EQ(keeper.step(), kLadder[0]);
  }
}

TEST(PaceKeeperTest, PicturesThatWereNotMeasuredDoNotCount) {
  Keeper keeper(kLadder, 0);
  for (int i = 0; i < 1000; ++i) keeper.advance(0.5, std::nullopt);
  EXPECT_EQ(keeper.step(), kLadder[0]);
}

TEST(PaceKeeperTest, GivesWayToALoadAfterThreeSecondsAndComesBackAMinuteAfterIt) {
  Keeper keeper(kLadder, 0);
  run_for(keeper, 120.0, [](double) { return Machine{0.014}; });
  const std::vector<Change> changes = run_for(keeper, 600.0, [](double now_s) {
    return Machine{now_s < 100.0 ? 0.014 : now_s < 200.0 ? 0.045 : 0.014};
  });
  ASSERT_EQ(changes.size(), 2U);
  EXPECT_GT(changes[0].at_s, 102.0);
  EXPECT_LT(changes[0].at_s, 107.0);
  EXPECT_EQ(changes[0].step, kLadder[2]);  // at once as far as needed
  EXPECT_GT(changes[1].at_s, 260.0);
  EXPECT_LT(changes[1].at_s, 270.0);
  EXPECT_EQ(changes[1].step, kLadder[1]);
}

TEST(PaceKeeperTest, ChangesAtMostTwiceInAnHourWhateverComes) {
  Keeper keeper(kLadder, 0);
  run_for(keeper, 120.0, [](double) { return Machine{0.014}; });
  std::vector<Change> changes = run_for(
      keeper, 5.0 * kHour_s, [](double now_s) { return Machine{std::fmod(now_s, 400.0) < 200.0 ? 0.1 : 0.005}; });
  EXPECT_GE(changes.size(), 8U);
  for (std::size_t i = 2; i < changes.size(); ++i) EXPECT_GE(changes[i].at_s - changes[i - 2].at_s, kHour_s);
}

TEST(PaceKeeperTest, TheGrassAndTheMeshesChangeSlowly) {
  Keeper keeper(kLadder, 0);
  DrawnPart before;
  for (double now_s = 0.0; now_s < 100.0;) {
    const double work_s = Machine{0.25}.work_s(keeper.step(), keeper.drawn());
    keeper.advance(work_s, work_s);
    now_s += work_s;
    const auto most = static_cast<float>(0.08 * work_s) + 1e-6F;
    EXPECT_LE(std::abs(keeper.drawn().blades - before.blades), most);
    EXPECT_LE(std::abs(keeper.drawn().coarseness - before.coarseness), most);
    before = keeper.drawn();
  }
  EXPECT_LT(before.blades, 0.6F);
}

TEST(PaceLadderTest, WhatIsGivenUpIsTheSameNumberInEveryLadder) {
  const std::array ladders{kLadder, Ladder(look::Quality::kAuto, 1.0 / 144.0), Ladder(look::Quality::kLow, kRefresh_s)};
  for (const Ladder& ladder : ladders) {
    for (std::uint8_t least = 0; least < 12; ++least) {
      const Step& step = ladder[ladder.giving_up(least)];
      if (least > 6) continue;
      EXPECT_EQ(Ladder::given_up(step), std::max(least, Ladder::given_up(ladder[0])));
      EXPECT_EQ(step.part, kLadder[kLadder.giving_up(least)].part);
    }
  }
}

TEST(PaceKeeperTest, DrawsNoMoreThanAnotherPartOfTheWall) {
  Keeper keeper(kLadder, 0);
  const auto quick = [](double) { return Machine{0.010}; };
  run_for(keeper, 10.0, quick);
  keeper.hold(3);
  run_for(keeper, 600.0, quick);
  EXPECT_EQ(keeper.step().quality, look::Quality::kLow);
  EXPECT_EQ(keeper.drawn(), Ladder::kParts[0]);
  EXPECT_EQ(keeper.given_up(), 0) << "nor does it say that it needs this itself";
  keeper.hold(1);
  EXPECT_EQ(keeper.step(), kLadder[2]);
  // Where it is the slower one, it goes further down.
  keeper.hold(0);
  run_for(keeper, 70.0, [](double) { return Machine{0.2}; });
  const std::uint8_t own = keeper.given_up();
  EXPECT_GE(own, 3);
  keeper.hold(1);
  EXPECT_EQ(Ladder::given_up(keeper.step()), own);
}

TEST(PaceKeeperTest, AnotherLadderBeginsWhereThePictureIs) {
  Keeper keeper(kLadder, kLadder.size() - 2);
  keeper.set_ladder(Ladder(look::Quality::kLow, kRefresh_s));
  EXPECT_EQ(keeper.step(), kLadder[kLadder.size() - 2]);
  keeper.set_ladder(Ladder(look::Quality::kHigh, kRefresh_s));
  EXPECT_EQ(keeper.step(), (Step{.quality = look::Quality::kHigh, .refreshes = 2}));
  keeper.set_ladder(kLadder);
  EXPECT_EQ(keeper.step(), kLadder[1]);
  Keeper quick(kLadder, 0);
  quick.set_ladder(Ladder(look::Quality::kMedium, 1.0 / 144.0));
  EXPECT_EQ(quick.step(), (Step{.quality = look::Quality::kMedium}));
}

TEST(PaceKeeperTest, TakesAnyTime) {
  Keeper keeper(kLadder, 0);
  for (const double time_s : {0.0, -1.0, 1e9, 1e-9}) {
    for (int i = 0; i < 1000; ++i) keeper.advance(time_s, time_s);
  }
  EXPECT_GE(keeper.drawn().blades, Ladder::kParts.back().blades);
  EXPECT_LE(keeper.drawn().blades, 1.0F);
}

}  // namespace
}  // namespace yuragi::viewer::pace
