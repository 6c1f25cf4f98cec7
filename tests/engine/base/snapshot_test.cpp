#include "engine/base/snapshot.hpp"

#include <array>
#include <chrono>
#include <limits>
#include <optional>
#include <vector>

#include <gtest/gtest.h>

namespace yuragi {
namespace {

enum class Mood : std::uint8_t { kCalm, kLively };

/// Something of each kind.
struct Creature {
  struct Leg {
    float lean = 0.0F;
    void list_state(StatePass& pass) { pass(lean); }
  };

  void list_state(StatePass& pass) {
    pass(weight, is_awake, tick, born, met, legs, ages);
    pass.within(phase, 0.0, 1.0);
    pass.index(place, 4);
    pass.choice(mood, Mood::kLively);
  }

  double weight = 1.0;
  bool is_awake = false;
  std::uint64_t tick = 0;
  MonoTime born{};
  UtcTime met{};
  std::array<Leg, 2> legs{};
  std::optional<double> ages;
  double phase = 0.0;
  std::size_t place = 0;
  Mood mood = Mood::kCalm;
};

Creature lively() {
  return {.weight = -2.5,
          .is_awake = true,
          .tick = std::numeric_limits<std::uint64_t>::max(),
          .born = MonoTime(std::chrono::seconds(40)),
          .met = UtcTime(std::chrono::seconds(1'700'000'000)),
          .legs = {Creature::Leg{0.5F}, Creature::Leg{-0.0F}},
          .ages = 7.0,
          .phase = 1.0,
          .place = 3,
          .mood = Mood::kLively};
}

std::string refusal_of(std::span<const std::uint8_t> snapshot, std::uint64_t made_of = 5) {
  Creature creature;
  const std::vector<std::uint8_t> before = save_snapshot(creature, made_of);
  const auto loaded = load_snapshot(creature, made_of, snapshot);
  if (loaded) return "loaded";
  EXPECT_EQ(save_snapshot(creature, made_of), before);
  EXPECT_EQ(loaded.error().kind, FailureKind::kBadData);
  return loaded.error().message;
}

/// Saves what load_snapshot() has to refuse.
template <class Spoil>
std::string refusal_after(Spoil spoil) {
  Creature creature = lively();
  spoil(creature);
  return refusal_of(save_snapshot(creature, 5));
}

TEST(SnapshotTest, LoadsWhatWasSaved) {
  Creature saved = lively();
  const std::vector<std::uint8_t> snapshot = save_snapshot(saved, 5);
  Creature loaded;
  ASSERT_TRUE(load_snapshot(loaded, 5, snapshot));
  EXPECT_EQ(loaded.weight, -2.5);
  EXPECT_EQ(loaded.legs[0].lean, 0.5F);
  EXPECT_EQ(loaded.ages, 7.0);
  EXPECT_EQ(loaded.met, saved.met);
  EXPECT_EQ(save_snapshot(loaded, 5), snapshot);
}

TEST(SnapshotTest, WhatIsAbsentIsAbsentAfterwards) {
  Creature saved;
  Creature loaded = lively();
  ASSERT_TRUE(load_snapshot(loaded, 5, save_snapshot(saved, 5)));
  EXPECT_FALSE(loaded.ages);
}

/// Legs that may become more.
struct Centipede {
  void list_state(StatePass& pass) {
    pass.grown(std::span(legs));
    pass(weight);
  }
  std::vector<double> legs;
  double weight = 1.0;
};

TEST(SnapshotTest, WhatWasAddedAtTheEndIsNotTouched_AndWhatIsMissingIsRefused) {
  Centipede saved{.legs = {1.0, 2.0}, .weight = 3.0};
  const auto snapshot = save_snapshot(saved, 5);
  Centipede grown{.legs = {7.0, 8.0, 9.0}};
  ASSERT_TRUE(load_snapshot(grown, 5, snapshot));
  EXPECT_EQ(grown.legs, (std::vector{1.0, 2.0, 9.0}));
  EXPECT_EQ(grown.weight, 3.0);
  Centipede fewer{.legs = {7.0}};
  const auto refused = load_snapshot(fewer, 5, snapshot);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().message, "is damaged: its length is wrong");
  EXPECT_EQ(fewer.legs, std::vector{7.0});
}

TEST(SnapshotTest, AgesRemainOnAnotherClock) {
  Creature saved = lively();
  const auto snapshot = save_snapshot(saved, 5, MonoTime(std::chrono::seconds(100)));
  Creature loaded;
  ASSERT_TRUE(load_snapshot(loaded, 5, snapshot, MonoTime(std::chrono::seconds(1000))));
  EXPECT_EQ(loaded.born, MonoTime(std::chrono::seconds(940)));
}

TEST(SnapshotTest, RefusesWhatIsNotItsOwn) {
  Creature creature = lively();
  const std::vector<std::uint8_t> snapshot = save_snapshot(creature, 5);
  EXPECT_EQ(refusal_of({}), "is not a snapshot");
  EXPECT_EQ(refusal_of(std::vector<std::uint8_t>(100, 1)), "is not a snapshot");
  EXPECT_EQ(refusal_of(std::span(snapshot).first(19)), "is damaged: it is too short");
  EXPECT_EQ(refusal_of(std::span(snapshot).first(snapshot.size() - 1)), "is damaged: its checksum is wrong");
  EXPECT_EQ(refusal_of(snapshot, 6), "is of another configuration");
  const auto state = opened_snapshot(snapshot, 5).value();
  EXPECT_EQ(refusal_of(closed_snapshot(state, 5, kMotionVersion + 1)),
            "is of version " + std::to_string(kMotionVersion + 1) + " of the motion; this program has version " +
                std::to_string(kMotionVersion));
  EXPECT_EQ(refusal_of(closed_snapshot(state.first(state.size() - 1), 5)), "is damaged: its length is wrong");
  EXPECT_EQ(refusal_of(closed_snapshot(snapshot, 5)), "is damaged: a number is out of its range");
  for (std::size_t bit = 0; bit < 8 * snapshot.size(); ++bit) {
    std::vector<std::uint8_t> damaged = snapshot;
    damaged[bit / 8] ^= static_cast<std::uint8_t>(1U << bit % 8);
    EXPECT_NE(refusal_of(damaged), "loaded") << "bit " << bit;
  }
}

TEST(SnapshotTest, RefusesNumbersOutOfTheirRange) {
  const std::string refused = "is damaged: a number is out of its range";
  EXPECT_EQ(refusal_after([](Creature& it) { it.weight = std::numeric_limits<double>::quiet_NaN(); }), refused);
  EXPECT_EQ(refusal_after([](Creature& it) { it.weight = 1.1 * StatePass::kLargest; }), refused);
  EXPECT_EQ(refusal_after([](Creature& it) { it.legs[1].lean = std::numeric_limits<float>::infinity(); }), refused);
  EXPECT_EQ(refusal_after([](Creature& it) { it.phase = 1.1; }), refused);
  EXPECT_EQ(refusal_after([](Creature& it) { it.phase = -0.1; }), refused);
  EXPECT_EQ(refusal_after([](Creature& it) { it.place = 4; }), refused);
  EXPECT_EQ(refusal_after([](Creature& it) { it.mood = Mood{2}; }), refused);
  EXPECT_EQ(refusal_after([](Creature& it) { it.ages = std::numeric_limits<double>::quiet_NaN(); }), refused);
  EXPECT_EQ(refusal_after([](Creature& it) { it.born = MonoTime::max(); }), refused);
  EXPECT_EQ(refusal_after([](Creature& it) { it.born = MonoTime::min(); }), refused);
}

}  // namespace
}  // namespace yuragi
