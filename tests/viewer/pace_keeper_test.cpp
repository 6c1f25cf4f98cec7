#include "viewer/pace_keeper.hpp"

#include <cmath>
#include <functional>
#include <vector>

#include <gtest/gtest.h>

namespace yuragi::viewer {
namespace {

constexpr double kPicture_s = 1.0 / 60.0;  // no more are made, whatever the work

/// A machine that needs so long for all of a picture, of which a part is the same however little is drawn.
struct Machine {
  double full_s;
  double fixed = 0.15;
  double work_s(const DrawnPart& part) const {
    const auto side = static_cast<double>(part.side);
    return full_s * (fixed + (1.0 - fixed) * (0.6 * side * side + 0.4 * static_cast<double>(part.blades)));
  }
};

struct Pictures {
  std::vector<std::size_t> steps;  // after each picture
  int changes = 0;
};

Pictures run_for(PaceKeeper& keeper, double time_s, const std::function<double(double, const DrawnPart&)>& work_s) {
  Pictures run;
  for (double now_s = 0.0; now_s < time_s;) {
    const double work = work_s(now_s, keeper.drawn());
    const double passed = std::max(work, kPicture_s);
    const std::size_t before = keeper.step();
    keeper.advance(passed, work);
    run.changes += keeper.step() != before ? 1 : 0;
    run.steps.push_back(keeper.step());
    now_s += passed;
  }
  return run;
}

TEST(PaceKeeperTest, DrawsEverythingWhereThatIsQuickEnough) {
  PaceKeeper keeper;
  const Pictures run =
      run_for(keeper, 600.0, [](double, const DrawnPart& part) { return Machine{0.030}.work_s(part); });
  EXPECT_EQ(run.changes, 0);
  EXPECT_EQ(keeper.drawn(), DrawnPart{});
}

TEST(PaceKeeperTest, HoldsThePaceOnMachinesOfManySpeedsAndStaysThere) {
  for (double full_s = 0.034; full_s < 0.075; full_s *= 1.05) {
    PaceKeeper keeper;
    const Machine machine{full_s};
    const auto work_s = [&](double, const DrawnPart& part) { return machine.work_s(part); };
    run_for(keeper, 30.0, work_s);
    EXPECT_LE(machine.work_s(keeper.drawn()), 1.05 * PaceKeeper::kTarget_s) << full_s;
    // And in a day hardly ever goes to and fro.
    const Pictures day = run_for(keeper, 4.0 * 3600.0, work_s);
    EXPECT_LE(day.changes, 12) << full_s;
  }
}

TEST(PaceKeeperTest, ASlowPictureNowAndThenChangesNothing) {
  PaceKeeper keeper;
  int picture = 0;
  const Pictures run =
      run_for(keeper, 300.0, [&](double, const DrawnPart&) { return ++picture % 20 == 0 ? 0.2 : 0.02; });
  EXPECT_EQ(run.changes, 0);
}

TEST(PaceKeeperTest, DrawsMoreAgainWhenTheMachineIsFree) {
  PaceKeeper keeper;
  const auto busy = [](double now_s, const DrawnPart& part) {
    return Machine{now_s < 60.0 ? 0.09 : 0.02}.work_s(part);
  };
  const Pictures run = run_for(keeper, 60.0 + 6.0 * PaceKeeper::kPatience_s, busy);
  EXPECT_GE(run.steps[1000], 2U);
  EXPECT_EQ(keeper.step(), 0U);
  EXPECT_EQ(keeper.drawn().side, 1.0F);
}

TEST(PaceKeeperTest, TriesMoreEverMoreSeldomWhereThatIsTooMuch) {
  // The worst machine: whatever the step, all is quick but the first.
  PaceKeeper keeper;
  const auto work_s = [](double, const DrawnPart& part) { return part.side == 1.0F ? 0.05 : 0.012; };
  const Pictures first = run_for(keeper, 600.0, work_s);
  const Pictures later = run_for(keeper, 6.0 * 3600.0, work_s);
  EXPECT_LE(first.changes, 14);
  EXPECT_LE(later.changes, 20);
}

TEST(PaceKeeperTest, TheGrassAndTheMeshesChangeSlowly) {
  PaceKeeper keeper;
  float before = 1.0F;
  float coarseness_before = 1.0F;
  run_for(keeper, 100.0, [&](double, const DrawnPart& part) {
    EXPECT_LE(std::abs(part.blades - before), 0.08F * 0.1F + 1e-6F);
    EXPECT_LE(std::abs(part.coarseness - coarseness_before), 0.08F * 0.1F + 1e-6F);
    before = part.blades;
    coarseness_before = part.coarseness;
    return Machine{0.09}.work_s(part);
  });
  EXPECT_LT(before, 0.6F);
}

TEST(PaceKeeperTest, TakesAnyTime) {
  PaceKeeper keeper;
  for (const double time_s : {0.0, -1.0, 1e9, 1e-9}) {
    for (int i = 0; i < 100; ++i) keeper.advance(time_s, time_s);
  }
  EXPECT_LT(keeper.step(), PaceKeeper::kSteps.size());
  EXPECT_GE(keeper.drawn().blades, PaceKeeper::kSteps.back().blades);
}

}  // namespace
}  // namespace yuragi::viewer
