#include "daemon/animation/animation.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <gtest/gtest.h>

#include "engine/base/snapshot.hpp"
#include "engine/pose/pose_arrays.hpp"
#include "engine/pose/pose_hash.hpp"
#include "tests/support/gusty_wind.hpp"
#include "tests/support/stroke_run.hpp"

namespace yuragi::daemon::animation {
namespace {

constexpr double kTick_s = 1.0 / 60.0;

/// A wind that nobody measures: the same everywhere.
wind::ground::DrivingWind everywhere(wind::Vector wind) {
  return {.state = {.wind = wind}, .ground = wind};
}
const wind::ground::DrivingWind kBreeze = everywhere({5.0, 1.0});

settings::Config installation(const std::string& first, const std::string& second) {
  const std::string small = "[[scene]]\nkind = \"grass\"\nblades_across = 12\nblades_deep = 8\n";
  return settings::parse_config(small + "name = \"first\"\n" + first + "\n" + small + "name = \"second\"\n" + second,
                                "test.toml");
}

Animation animation_of(const settings::Config& config) {
  return {config, shared_gusts()};
}

wire::Frame shown_by(Animation& animation) {
  return std::get<wire::Frame>(wire::decode(animation.encode({}).subspan(wire::kSizePrefixBytes)).value());
}

float largest(const pose::Pose& pose) {
  float most = 0.0F;
  pose::for_each_array(pose, [&most](std::span<const float> values) {
    for (const float value : values) most = std::max(most, std::abs(value));
  });
  return most;
}

TEST(AnimationTest, ASceneStandsWhereTheConfigurationSays) {
  const Animation here = animation_of(installation("", "shown = false"));
  const Animation there = animation_of(installation("x = 30\ny = 2\nz = -4\n", "heading = 90"));
  const auto& a = std::get<pose::StrandSkeleton>(*here.skeletons()[0]);
  const auto& b = std::get<pose::StrandSkeleton>(*there.skeletons()[0]);
  EXPECT_NEAR(b.root_x_m[7], a.root_x_m[7] + 30.0F, 1e-4);
  EXPECT_NEAR(b.root_y_m[7], a.root_y_m[7] + 2.0F, 1e-4);
  EXPECT_NEAR(b.root_z_m[7], a.root_z_m[7] - 4.0F, 1e-4);

  // What was north, -z, is east.
  const auto& c = std::get<pose::StrandSkeleton>(*here.skeletons()[1]);
  const auto& d = std::get<pose::StrandSkeleton>(*there.skeletons()[1]);
  EXPECT_NEAR(d.root_x_m[7], -c.root_z_m[7], 1e-4);
  EXPECT_NEAR(d.root_z_m[7], c.root_x_m[7], 1e-4);
  EXPECT_EQ(here.node_count(), 2 * pose::node_count(*here.skeletons()[0]));
}

TEST(AnimationTest, GainIsAFactorOnTheWindThatASceneFeels) {
  Animation one = animation_of(installation("gain = 2", "gain = 0"));
  Animation other = animation_of(installation("", ""));
  for (int tick = 0; tick < 90; ++tick) {
    one.step(kBreeze, kTick_s);
    other.step(everywhere({10.0, 2.0}), kTick_s);
  }
  EXPECT_EQ(pose::pose_hash(pose::kPoseHashSeed, *one.poses()[0]),
            pose::pose_hash(pose::kPoseHashSeed, *other.poses()[0]));
  EXPECT_GT(largest(*one.poses()[0]), 0.1F);
  EXPECT_EQ(largest(*one.poses()[1]), 0.0F) << "no wind, no bend";
}

TEST(AnimationTest, PosesDoNotDependOnHowManyThreadsShareATick) {
  const auto hash_with = [](std::size_t threads) {
    settings::Config config = installation("", "");
    config.animation.threads = threads;
    Animation animation = animation_of(config);
    for (int tick = 0; tick < 30; ++tick) animation.step(everywhere({6.0, 2.0}), kTick_s);
    std::uint64_t hash = pose::kPoseHashSeed;
    for (const pose::Pose* pose : animation.poses()) hash = pose::pose_hash(hash, *pose);
    return hash;
  };
  EXPECT_EQ(hash_with(3), hash_with(1));
}

TEST(AnimationTest, AHiddenSceneStandsStillAndSendsNothing) {
  const settings::Config config = installation("", "shown = false");
  Animation animation = animation_of(config);
  for (int tick = 0; tick < 60; ++tick) animation.step(kBreeze, kTick_s);
  EXPECT_GT(largest(*animation.poses()[0]), 0.0F);
  EXPECT_EQ(largest(*animation.poses()[1]), 0.0F);
  const std::size_t bytes = animation.encode({}).size();
  const wire::Frame frame = shown_by(animation);
  EXPECT_EQ(frame.opacities, (std::vector{1.0F, 0.0F}));
  EXPECT_TRUE(std::get<pose::StrandPose>(frame.poses[1]).bend_east_rad.empty());
  EXPECT_LT(bytes, animation.largest_frame_bytes() * 2 / 3);
  EXPECT_TRUE(wire::fits(frame, animation.describe()));
}

TEST(AnimationTest, OneThatIsLoadedGoesOnWithTheFramesOfTheOneThatWasSaved) {
  const auto wind_at = [](int tick) { return everywhere({5.0 + 3.0 * std::sin(0.1 * tick), std::cos(0.03 * tick)}); };
  const settings::Config config = installation("", "shown = false");
  Animation saved = animation_of(config);
  for (int tick = 0; tick < 60; ++tick) saved.step(wind_at(tick), kTick_s);
  saved.cue({.scene = 1, .shown = true, .over_s = 2.0});
  for (int tick = 60; tick < 120; ++tick) saved.step(wind_at(tick), kTick_s);
  const std::vector<std::uint8_t> snapshot = save_snapshot(saved, 1);

  Animation loaded = animation_of(config);
  for (int tick = 0; tick < 7; ++tick) loaded.step(kBreeze, kTick_s);
  ASSERT_TRUE(load_snapshot(loaded, 1, snapshot));
  for (int tick = 120; tick < 300; ++tick) {
    saved.step(wind_at(tick), kTick_s);
    loaded.step(wind_at(tick), kTick_s);
    const auto frame = saved.encode({});
    ASSERT_TRUE(std::ranges::equal(frame, loaded.encode({}))) << "tick " << tick;
  }
}

TEST(AnimationTest, MeasuresWhatEachSceneTakesOfATick) {
  const settings::Config config = installation("", "shown = false");
  Animation animation = animation_of(config);
  const auto scenes = animation.roster()->scenes;
  for (int tick = 0; tick < 10; ++tick) animation.step(kBreeze, kTick_s);
  EXPECT_GT(scenes[0]->step_time.mean_s(), 0.0);
  EXPECT_EQ(scenes[1]->step_time.mean_s(), 0.0) << "it is hidden";
  animation.cue({.scene = 1, .shown = true, .hide_others = true, .over_s = 0.0});
  for (int tick = 0; tick < 10; ++tick) animation.step(kBreeze, kTick_s);
  EXPECT_EQ(scenes[0]->step_time.mean_s(), 0.0) << "it has been hidden";
  EXPECT_GT(scenes[1]->step_time.mean_s(), 0.0);
}

TEST(AnimationTest, ACrossFadeTakesItsTimeAndNeverJumps) {
  const settings::Config config = installation("", "shown = false");
  Animation animation = animation_of(config);
  animation.step(kBreeze, kTick_s);
  animation.cue({.scene = 1, .shown = true, .hide_others = true, .over_s = 2.0});
  std::vector<float> before(animation.opacities().begin(), animation.opacities().end());
  for (int tick = 1; tick <= 120; ++tick) {
    animation.step(kBreeze, kTick_s);
    const auto now = animation.opacities();
    EXPECT_LE(before[1], now[1]);
    EXPECT_NEAR(now[0] + now[1], 1.0F, 1e-6F);
    EXPECT_LT(now[1] - before[1], 1.5 / 120.0 * 1.001) << "the steepest of a smooth step";
    if (tick < 119) {
      EXPECT_LT(now[1], 1.0F);
    }
    before.assign(now.begin(), now.end());
  }
  EXPECT_EQ(animation.opacities()[0], 0.0F);
  EXPECT_EQ(animation.opacities()[1], 1.0F);
  EXPECT_EQ(shown_by(animation).opacities, (std::vector{0.0F, 1.0F}));
}

TEST(AnimationTest, AFadeThatIsTurnedRoundGoesOnFromWhereItIs) {
  const settings::Config config = installation("", "");
  Animation animation = animation_of(config);
  animation.cue({.scene = 0, .shown = false, .over_s = 1.0});
  for (int tick = 0; tick < 24; ++tick) animation.step(kBreeze, kTick_s);
  const float midway = animation.opacities()[0];
  EXPECT_GT(midway, 0.4F);
  EXPECT_LT(midway, 0.9F);
  animation.cue({.scene = 0, .shown = true, .over_s = 1.0});
  animation.step(kBreeze, kTick_s);
  EXPECT_NEAR(animation.opacities()[0], midway, 0.01F);
  for (int tick = 0; tick < 60; ++tick) animation.step(kBreeze, kTick_s);
  EXPECT_EQ(animation.opacities()[0], 1.0F);
  EXPECT_EQ(animation.opacities()[1], 1.0F) << "the other was not asked to do anything";
}

TEST(AnimationTest, AFadeOfNoTimeIsDoneAtTheNextTickAndASceneThatIsNotThereIsIgnored) {
  const settings::Config config = installation("", "");
  Animation animation = animation_of(config);
  animation.cue({.scene = 7, .shown = true, .hide_others = true, .over_s = 0.0});
  animation.cue({.scene = 1, .shown = false, .over_s = 0.0});
  animation.step(kBreeze, kTick_s);
  EXPECT_EQ(animation.opacities()[0], 1.0F);
  EXPECT_EQ(animation.opacities()[1], 0.0F);
}

/// A wind toward north of 6 m/s that is measured 20 m south of the middle, with a gust after 20 s.
class MeasuredGust {
 public:
  MeasuredGust() {
    run_.blow({0.0, 6.0});
    run_.take_only(kBand);
  }
  wind::ground::DrivingWind next() {
    const bool is_gust = ++tick_ > 20 * 60;
    run_.step([is_gust](std::size_t, wind::ground::WindSample& now) { now.north_m_s[kBand] = is_gust ? 4.0F : 0.0F; });
    return {.state = {.wind = run_.wind()}, .ground = run_.wind(), .stroke = run_.stroke()};
  }

 private:
  static constexpr std::size_t kBand = 3;
  StrokeRun run_{{{0.0, 20.0}}};
  int tick_ = 0;
};

TEST(AnimationTest, AMeasuredGustReachesASceneAfterItsWay) {
  // Without waves of the meadow's own, which are there before the gust.
  Animation animation = animation_of(installation("z = 16\ncanopy_waves = 0", "z = -14\ncanopy_waves = 0"));
  ASSERT_GT(animation.reach_m(), 16.0);
  MeasuredGust wind;
  std::array<float, 2> steady{};
  std::array<int, 2> reached_at{};
  for (int tick = 0; tick < 32 * 60; ++tick) {
    animation.step(wind.next(), kTick_s);
    for (std::size_t i = 0; i < 2; ++i) {
      const float bend = largest(*animation.poses()[i]);
      if (tick == 20 * 60 - 1) steady[i] = bend;
      if (tick >= 20 * 60 && reached_at[i] == 0 && bend > 1.2F * steady[i]) reached_at[i] = tick;
    }
  }
  ASSERT_GT(reached_at[0], 0);
  ASSERT_GT(reached_at[1], 0);
  EXPECT_NEAR((reached_at[0] - 20 * 60) * kTick_s, 4.0 / 6.0, 0.5) << "and what a scene needs to bend";
  EXPECT_NEAR((reached_at[1] - reached_at[0]) * kTick_s, 30.0 / 6.0, 0.3);
}

TEST(AnimationTest, WhatIsMeasuredMovesScenesAlikeHoweverManyThreadsThereAre) {
  const auto hash_with = [](std::size_t threads) {
    settings::Config config = installation("z = 16", "z = -14");
    config.animation.threads = threads;
    Animation animation = animation_of(config);
    MeasuredGust wind;
    for (int tick = 0; tick < 22 * 60; ++tick) animation.step(wind.next(), kTick_s);
    std::uint64_t hash = pose::kPoseHashSeed;
    for (const pose::Pose* pose : animation.poses()) hash = pose::pose_hash(hash, *pose);
    return hash;
  };
  EXPECT_EQ(hash_with(3), hash_with(1));
}

TEST(AnimationTest, GainIsAFactorOnTheWindThatIsMeasured) {
  Animation without = animation_of(installation("gain = 0", "gain = 1"));
  MeasuredGust wind;
  for (int tick = 0; tick < 60; ++tick) without.step(wind.next(), kTick_s);
  EXPECT_EQ(largest(*without.poses()[0]), 0.0F);
  EXPECT_GT(largest(*without.poses()[1]), 0.0F);
}

}  // namespace
}  // namespace yuragi::daemon::animation
