#include "engine/wind/blend/source_choice.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

namespace yuragi::wind::blend {
namespace {

constexpr double kChoiceTick_s = 0.1;

/// A choice, and who is live.
class Choice {
 public:
  /// What the first step finds is taken at once: here nobody.
  explicit Choice(std::vector<SourceSettings> sources) : count_(sources.size()), choice_(sources, 3.0, 10.0) {
    choice_.step(0.0);
  }
  void run_for(double duration_s, const std::vector<bool>& live) {
    for (int i = 0; i < static_cast<int>(std::lround(duration_s / kChoiceTick_s)); ++i) {
      for (std::size_t source = 0; source < count_; ++source) choice_.set_live(source, live[source]);
      const double before = choice_.weight(0);
      choice_.step(kChoiceTick_s);
      largest_step_ = std::max(largest_step_, std::abs(choice_.weight(0) - before));
    }
  }
  double weight(std::size_t source) const { return choice_.weight(source); }
  double gusts(std::size_t source) const { return choice_.gusts(source); }
  double largest_step() const { return largest_step_; }

 private:
  std::size_t count_;
  SourceChoice choice_;
  double largest_step_ = 0.0;
};

TEST(SourceChoice, GivesTheWeightInTheOrderOfTheSources) {
  Choice choice({{}, {}});
  choice.run_for(20.0, {true, true});
  EXPECT_NEAR(choice.weight(0), 1.0, 1e-3);
  EXPECT_NEAR(choice.weight(1), 0.0, 1e-3);
}

TEST(SourceChoice, ASourceThatIsLiveBeforeTheFirstStepHasItsWeightAtOnce) {
  SourceChoice choice(std::vector<SourceSettings>(2), 3.0, 10.0);
  choice.set_live(1, true);
  choice.step(0.0);
  EXPECT_EQ(choice.weight(0), 0.0);
  EXPECT_EQ(choice.weight(1), 1.0);
  // Who comes later has to wait for the way there.
  choice.set_live(0, true);
  choice.step(kChoiceTick_s);
  EXPECT_LT(choice.weight(0), 0.02);
}

TEST(SourceChoice, ThoseOfTheLowestPriorityShareByWeight) {
  Choice choice({{.priority = 2}, {.priority = 1, .weight = 1.0}, {.priority = 1, .weight = 3.0}});
  choice.run_for(20.0, {true, true, true});
  EXPECT_NEAR(choice.weight(0), 0.0, 1e-3);
  EXPECT_NEAR(choice.weight(1), 0.25, 1e-3);
  EXPECT_NEAR(choice.weight(2), 0.75, 1e-3);
}

TEST(SourceChoice, ASourceThatFailedWaitsBeforeItTakesOver) {
  Choice choice({{}, {}});
  choice.run_for(20.0, {true, true});
  choice.run_for(20.0, {false, true});
  EXPECT_NEAR(choice.weight(1), 1.0, 1e-3);
  choice.run_for(9.0, {true, true});
  EXPECT_NEAR(choice.weight(1), 1.0, 1e-3) << "not yet";
  choice.run_for(20.0, {true, true});
  EXPECT_NEAR(choice.weight(0), 1.0, 1e-3);
  // 0.37 e w at most.
  EXPECT_LT(choice.largest_step(), 0.37 * 4.0 / 3.0 * kChoiceTick_s * 1.01);
}

TEST(SourceChoice, AFlappingSourceIsLeftAloneForLongerAndLonger) {
  Choice choice({{}, {}});
  choice.run_for(60.0, {true, true});
  double with_the_first_s = 0.0;
  constexpr int kFlaps = 40;
  for (int i = 0; i < kFlaps; ++i) {
    choice.run_for(5.0, {false, true});
    for (int second = 0; second < 15; ++second) {
      choice.run_for(1.0, {true, true});
      if (i > 2 && choice.weight(0) > 0.1) with_the_first_s += 1.0;
    }
  }
  EXPECT_EQ(with_the_first_s, 0.0) << "15 s at a time are not enough any more";
  // And in the end it is believed again, and forgiven.
  choice.run_for(700.0, {true, true});
  EXPECT_NEAR(choice.weight(0), 1.0, 1e-3);
  choice.run_for(20.0, {false, true});
  choice.run_for(25.0, {true, true});
  EXPECT_NEAR(choice.weight(0), 1.0, 0.01);
}

TEST(SourceChoice, NobodyElseMeansNoWaiting) {
  Choice choice(std::vector<SourceSettings>(1));
  choice.run_for(20.0, {true});
  choice.run_for(20.0, {false});
  EXPECT_NEAR(choice.weight(0), 1.0, 1e-3) << "while its trust fades, the word is still its";
  Choice two({{}, {}});
  two.run_for(20.0, {true, true});
  two.run_for(20.0, {false, false});
  two.run_for(8.0, {false, true});
  EXPECT_NEAR(two.weight(1), 1.0, 0.01);
}

TEST(SourceChoice, ARelativeSourceHasTheGustsAndAloneAllTheWeight) {
  Choice choice({{}, {.is_relative = true}});
  choice.run_for(20.0, {true, true});
  EXPECT_NEAR(choice.weight(0), 1.0, 1e-3);
  EXPECT_NEAR(choice.weight(1), 0.0, 1e-3);
  EXPECT_NEAR(choice.gusts(1), 1.0, 1e-3);
  choice.run_for(20.0, {false, true});
  EXPECT_NEAR(choice.weight(1), 1.0, 1e-3);
  EXPECT_NEAR(choice.gusts(1), 0.0, 1e-3);
  choice.run_for(40.0, {true, true});
  EXPECT_NEAR(choice.weight(0), 1.0, 1e-3);
  EXPECT_NEAR(choice.gusts(1), 1.0, 1e-3);
}

TEST(SourceChoice, APriorityDoesNotMakeARelativeSourceAbsolute) {
  Choice choice({{.priority = 5}, {.is_relative = true, .priority = 1}});
  choice.run_for(20.0, {true, true});
  EXPECT_NEAR(choice.weight(0), 1.0, 1e-3);
}

}  // namespace
}  // namespace yuragi::wind::blend
