#include "daemon/animation/led_steps.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "engine/pose/pose_hash.hpp"
#include "tests/support/gusty_wind.hpp"
#include "tests/support/measured_wind.hpp"

namespace yuragi::daemon::animation {
namespace {

constexpr double kRate_hz = 60.0;
constexpr Nanoseconds kDelay = std::chrono::milliseconds(300);
const Nanoseconds kPeriod = from_seconds(1.0 / kRate_hz);
const UtcTime kBegin{std::chrono::seconds(1'800'000'000)};

/// Scenes whose states differ in kind: oscillators, a cloth, a surface, and one that is hidden.
settings::Config installation(const std::string& wind = "lead = \"nats://127.0.0.1:4222\"") {
  return settings::parse_config("[wind]\n" + wind + R"(
[[scene]]
name = "meadow"
kind = "grass"
blades_across = 12
blades_deep = 8
[[scene]]
name = "cloth"
kind = "flag"
columns = 16
rows = 10
[[scene]]
name = "pond"
kind = "ripple"
[[scene]]
name = "second"
kind = "grass"
blades_across = 12
blades_deep = 8
shown = false
)",
                                "test.toml");
}

/// The ticks of a leader: a measured wind, from number 1001 on.
std::vector<wire::lead::WindTick> ticks_of_leader(std::size_t count, std::uint64_t epoch = 5) {
  MeasuredWind measured(shared_gusts(), {6.0, 3.0});
  std::vector<wire::lead::WindTick> ticks;
  for (std::uint64_t number = 1001; ticks.size() < count; ++number) {
    ticks.push_back({.epoch = epoch,
                     .number = number,
                     .utc = kBegin + static_cast<Nanoseconds::rep>(number) * kPeriod,
                     .wind = measured.step()});
  }
  return ticks;
}

/// An animation and its steps, with a clock of its own.
class Wall {
 public:
  explicit Wall(bool leads = false, std::uint64_t number = 500)
      : leads_(leads), animation_(installation(), shared_gusts()), steps_(number, kRate_hz, kDelay) {}

  LedSteps& steps() { return steps_; }
  LedSteps::Position at() const { return steps_.position(); }

  void give(const wire::lead::WindTick& tick) { ASSERT_TRUE(steps_.push(due(tick), tick, leads_)); }
  MonoTime due(const wire::lead::WindTick& tick) const {
    return MonoTime(static_cast<Nanoseconds::rep>(tick.number) * kPeriod);
  }

  /// A tick of the loop, when `number` is due.
  LedSteps::Stepped step_at(std::uint64_t number, std::uint64_t periods = 1) {
    const LedSteps::Stepped stepped =
        steps_.step(animation_, own_, MonoTime(static_cast<Nanoseconds::rep>(number) * kPeriod + kPeriod / 2), periods);
    wire::Frame shown = shown_frame();
    if (last_) largest_step_ = std::max(largest_step_, largest_difference(*last_, shown));
    last_ = std::move(shown);
    return stepped;
  }
  /// Of what is shown, between two frames.
  float largest_step() const { return largest_step_; }
  void forget_steps() { largest_step_ = 0.0F; }

  std::uint64_t hash() const {
    std::uint64_t hash = pose::kPoseHashSeed;
    for (const pose::Pose* pose : animation_.poses()) hash = pose::pose_hash(hash, *pose);
    return hash;
  }

  std::vector<float> opacities() const { return {animation_.opacities().begin(), animation_.opacities().end()}; }

  void save() {
    auto order = std::make_unique<StateOrder>();
    EXPECT_TRUE(steps_.order(order));
  }
  void load(const StateOrder& saved) {
    auto order = std::make_unique<StateOrder>(StateOrder{
        .kind = StateOrder::Kind::kLoad, .number = saved.number, .state = saved.state, .shown = {1, 1, 1, 1}});
    EXPECT_TRUE(steps_.order(order));
  }

 private:
  wire::Frame shown_frame() {
    return std::get<wire::Frame>(wire::decode(animation_.encode({}).subspan(wire::kSizePrefixBytes)).value());
  }
  static float largest_difference(const wire::Frame& one, const wire::Frame& other) {
    float largest = 0.0F;
    for (std::size_t scene = 0; scene < one.poses.size(); ++scene) {
      const pose::Arrays<const float> a(one.poses[scene]), b(other.poses[scene]);
      for (std::size_t array = 0; array < std::min(a.size(), b.size()); ++array) {
        for (std::size_t i = 0; i < std::min(a[array].size(), b[array].size()); ++i)
          largest = std::max(largest, std::abs(a[array][i] - b[array][i]));
      }
    }
    return largest;
  }

  bool leads_;
  Animation animation_;
  LedSteps steps_;
  wind::ground::DrivingWind own_{.state = {.wind = {-8.0, 1.0}}, .ground = wind::Vector{-8.0, 1.0}};
  std::optional<wire::Frame> last_;
  float largest_step_ = 0.0F;
};

TEST(LedSteps, WithoutALeaderTheOwnWindMovesTheScenesUnderNumbersThatContinue) {
  Wall wall;
  const std::uint64_t at_rest = wall.hash();
  const auto first = wall.step_at(1);
  EXPECT_EQ(first.number, 501U);
  EXPECT_FALSE(first.utc);
  EXPECT_EQ(first.wind->wind.u_m_s, -8.0);
  EXPECT_EQ(wall.step_at(4, 3).number, 504U);
  EXPECT_NE(wall.hash(), at_rest);
  EXPECT_FALSE(wall.at().is_led);
}

TEST(LedSteps, ALeaderAndAFollowerThatBeganTogetherHaveTheSamePosesAtEachNumber) {
  Wall leader(true), follower(false, 77);
  for (const auto& tick : ticks_of_leader(120)) {
    leader.give(tick);
    follower.give(tick);
    EXPECT_EQ(leader.step_at(tick.number).number, tick.number);
    const auto stepped = follower.step_at(tick.number);
    EXPECT_EQ(stepped.number, tick.number);
    EXPECT_EQ(stepped.utc, tick.utc + kDelay);
    ASSERT_EQ(follower.hash(), leader.hash()) << tick.number;
  }
  EXPECT_TRUE(leader.at().is_exact) << "what it has is what the others get";
  EXPECT_FALSE(follower.at().is_exact) << "it knows nothing of the leader's state before";
  EXPECT_EQ(follower.at().made, 120U);
}

TEST(LedSteps, ATickThatIsNotDueWaitsAndTwoThatAreDueAreBothMade) {
  Wall wall;
  const auto ticks = ticks_of_leader(3);
  for (const auto& tick : ticks) wall.give(tick);
  EXPECT_TRUE(wall.step_at(1001).is_new);
  EXPECT_FALSE(wall.step_at(1001).is_new) << "the loop is a little ahead of the leader";
  EXPECT_EQ(wall.step_at(1003).number, 1003U);
  EXPECT_EQ(wall.at().made, 3U);
}

TEST(LedSteps, WhileATickIsMissingTheLastWindGoesOnAndItsPosesAreNotTheLeadersAnyMore) {
  Wall wall(true);
  const auto ticks = ticks_of_leader(40);
  for (std::size_t i = 0; i < 20; ++i) {
    wall.give(ticks[i]);
    wall.step_at(ticks[i].number);
  }
  EXPECT_TRUE(wall.at().is_exact);
  std::uint64_t number = ticks[19].number;
  for (int tick = 0; tick < 10; ++tick) wall.step_at(++number);
  EXPECT_TRUE(wall.at().is_led);
  EXPECT_FALSE(wall.at().is_exact);
  EXPECT_GE(wall.at().without_tick, 7U);

  // What comes now goes on at its number.
  wall.give(ticks[35]);
  EXPECT_EQ(wall.step_at(ticks[35].number).number, ticks[35].number);
  EXPECT_FALSE(wall.at().is_exact);
}

TEST(LedSteps, AFollowerThatLoadsTheLeadersStateHasItsPosesAndWhatIsShownDoesNotJump) {
  Wall leader(true), follower;
  const auto ticks = ticks_of_leader(400);
  std::vector<std::uint64_t> hashes;
  std::unique_ptr<StateOrder> saved;
  for (const auto& tick : ticks) {
    leader.give(tick);
    leader.step_at(tick.number);
    hashes.push_back(leader.hash());
    if (tick.number == 1200) leader.save();
    if (auto finished = leader.steps().take_finished()) saved = std::move(finished);
  }
  ASSERT_TRUE(saved);
  ASSERT_TRUE(saved->is_done);
  EXPECT_EQ(saved->number, 1200U);

  // It comes late, after some ticks, with a wind of its own until then.
  for (std::uint64_t number = 1000; number < 1185; ++number) follower.step_at(number);
  std::size_t i = 185;
  for (; i < 205; ++i) {
    follower.give(ticks[i]);
    follower.step_at(ticks[i].number);
  }
  EXPECT_NE(follower.hash(), hashes[i - 1]);
  EXPECT_FALSE(follower.at().is_exact);
  const float usual_step = follower.largest_step();
  follower.forget_steps();
  follower.load(*saved);
  for (std::size_t again = 200; again < 205; ++again) follower.give(ticks[again]);
  bool is_caught_up = false;
  for (; i < ticks.size(); ++i) {
    follower.give(ticks[i]);
    const auto stepped = follower.step_at(ticks[i].number);
    EXPECT_EQ(follower.hash(), hashes[stepped.number - 1001]) << stepped.number;
    is_caught_up = is_caught_up || stepped.number == ticks[i].number;
    EXPECT_EQ(stepped.number == ticks[i].number, is_caught_up);
  }
  EXPECT_TRUE(is_caught_up);
  EXPECT_TRUE(follower.at().is_exact);
  const auto loaded = follower.steps().take_finished();
  ASSERT_TRUE(loaded);
  EXPECT_TRUE(loaded->is_done);
  EXPECT_EQ(loaded->shown, (std::vector<std::uint8_t>{1, 1, 1, 0}));
  EXPECT_LT(follower.largest_step(), 3.0F * usual_step);
}

TEST(LedSteps, AStateThatDoesNotFitIsRefusedAndNothingChanges) {
  Wall wall(true);
  const auto ticks = ticks_of_leader(10);
  for (const auto& tick : ticks) {
    wall.give(tick);
    wall.step_at(tick.number);
  }
  const std::uint64_t before = wall.hash();
  StateOrder bad;
  bad.number = 3;
  bad.state.resize(100);
  wall.load(bad);
  wall.step_at(ticks.back().number);
  const auto finished = wall.steps().take_finished();
  ASSERT_TRUE(finished);
  EXPECT_FALSE(finished->is_done);
  EXPECT_EQ(wall.hash(), before);
  EXPECT_EQ(wall.at().number, ticks.back().number);
}

TEST(LedSteps, AnotherEpochBeginsWithItsOwnNumberAndIsNotTheSamePicture) {
  Wall follower, leader(true);
  for (const auto& tick : ticks_of_leader(20)) {
    follower.give(tick);
    leader.give(tick);
    follower.step_at(tick.number);
    leader.step_at(tick.number);
  }
  const auto next = ticks_of_leader(5, 6);
  follower.give(next[0]);
  leader.give(next[0]);
  EXPECT_EQ(follower.step_at(1021).number, 1001U);
  leader.step_at(1021);
  EXPECT_EQ(follower.at().epoch, 6U);
  EXPECT_FALSE(follower.at().is_exact);
  EXPECT_TRUE(leader.at().is_exact) << "its own state is what an epoch of its own begins with";
}

TEST(LedSteps, TheOwnWindTakesOverWhenItIsOrdered) {
  Wall wall;
  const auto ticks = ticks_of_leader(10);
  for (const auto& tick : ticks) {
    wall.give(tick);
    EXPECT_EQ(wall.step_at(tick.number).wind->wind.u_m_s, tick.wind.state.wind.u_m_s);
  }
  ASSERT_TRUE(wall.steps().use_own_wind());
  const auto stepped = wall.step_at(1011);
  EXPECT_EQ(stepped.wind->wind.u_m_s, -8.0);
  EXPECT_EQ(stepped.number, 1011U);
  EXPECT_FALSE(wall.at().is_led);
}

TEST(LedSteps, ACueOfATickIsCarriedOutWithIt) {
  Wall wall;
  auto ticks = ticks_of_leader(2);
  ticks[1].cue_count = 1;
  ticks[1].cues[0] = {.scene = 3, .shown = true, .hide_others = true, .over_s = 0.0};
  for (const auto& tick : ticks) wall.give(tick);
  wall.step_at(1001);
  EXPECT_EQ(wall.opacities(), (std::vector<float>{1, 1, 1, 0}));
  wall.step_at(1002);
  EXPECT_EQ(wall.opacities(), (std::vector<float>{0, 0, 0, 1}));
}

TEST(LedSteps, AMachineThatIsFarBehindLeavesTicksOut) {
  Wall wall;
  for (const auto& tick : ticks_of_leader(400)) wall.give(tick);
  wall.step_at(1400);
  EXPECT_GE(wall.at().too_late, 95U);
  EXPECT_FALSE(wall.at().is_exact);
  for (std::uint64_t number = 1401; number < 1600; ++number) wall.step_at(number);
  EXPECT_GE(wall.at().number, 1400U);
}

}  // namespace
}  // namespace yuragi::daemon::animation
