#include "daemon/animation/scene_change.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "daemon/animation/animation.hpp"
#include "daemon/animation/scene_director.hpp"
#include "engine/pose/kinematics.hpp"
#include "engine/pose/pose_arrays.hpp"
#include "engine/pose/pose_hash.hpp"
#include "tests/support/gusty_wind.hpp"

namespace yuragi::daemon::animation {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

constexpr double kChangeTick_s = 1.0 / 60.0;
constexpr int kFadeTicks = 120;

/// One of each kind that moves differently, small.
constexpr std::array<const char*, 4> kSmallScenes = {
    "kind = \"grass\"\nname = \"meadow\"\nblades_across = 8\nblades_deep = 6\n",
    "kind = \"curtain\"\nname = \"curtain\"\nx = 3\ncolumns = 40\nrows = 30\n",
    "kind = \"flag\"\nname = \"flag\"\nz = 4\ncolumns = 40\nrows = 30\n",
    "kind = \"flame\"\nname = \"fire\"\nz = -4\n",
};

settings::Config config_of(const std::vector<std::string>& scenes) {
  std::string text;
  for (const std::string& scene : scenes) text += "[[scene]]\n" + scene;
  return settings::parse_config(text, "test.toml");
}

std::vector<std::string> small_scenes() {
  return {kSmallScenes.begin(), kSmallScenes.end()};
}

std::vector<std::string> names_of(const Animation& animation) {
  std::vector<std::string> names;
  for (const wire::SceneModel& scene : animation.describe().scenes) names.push_back(scene.name);
  return names;
}

std::vector<pose::JointPosition> joints_of(const pose::Skeleton& skeleton, const pose::Pose& pose) {
  pose::Kinematics kinematics(skeleton);
  EXPECT_TRUE(kinematics.run(pose));
  std::vector<pose::JointPosition> joints;
  for (std::size_t i = 0; i < pose::node_count(skeleton); ++i) joints.push_back(kinematics.joint(i));
  return joints;
}

double farthest_step_m(const std::vector<pose::JointPosition>& from, const std::vector<pose::JointPosition>& to) {
  double farthest_m = 0.0;
  for (std::size_t i = 0; i < from.size(); ++i) {
    farthest_m = std::max(farthest_m, static_cast<double>(std::hypot(to[i].x_m - from[i].x_m, to[i].y_m - from[i].y_m,
                                                                     to[i].z_m - from[i].z_m)));
  }
  return farthest_m;
}

/// An animation in a gusty wind, and what its scenes did from tick to tick: a scene is known by its pose's address.
class SceneChangeTest : public testing::Test {
 protected:
  struct Seen {
    std::vector<pose::JointPosition> joints;
    float opacity = 0.0F;
  };

  static Animation animation_of(const settings::Config& config) { return {config, shared_gusts()}; }

  wind::ground::DrivingWind blow() { return {.state = {}, .ground = wind_.step(kChangeTick_s)}; }

  /// A tick; its scenes may not jump.
  void step(Animation& animation) { step(animation, blow()); }
  void step(Animation& animation, const wind::ground::DrivingWind& wind) {
    animation.step(wind, kChangeTick_s);
    std::map<const pose::Pose*, Seen> now;
    for (std::size_t i = 0; i < animation.poses().size(); ++i) {
      const pose::Pose* pose = animation.poses()[i];
      const Seen seen{.joints = joints_of(*animation.skeletons()[i], *pose), .opacity = animation.opacities()[i]};
      const auto before = seen_.find(pose);
      const float opacity_before = before == seen_.end() ? 0.0F : before->second.opacity;
      EXPECT_LE(std::abs(seen.opacity - opacity_before), 1.5F / kFadeTicks * 1.001F) << "the steepest of a smooth step";
      if (before != seen_.end()) {
        const double bound_m = bounds_m_.at(pose);
        EXPECT_LE(farthest_step_m(before->second.joints, seen.joints), bound_m * (1.0 + 1e-5) + 1e-5);
      }
      now.emplace(pose, seen);
    }
    for (const auto& [pose, seen] : seen_) {
      if (!now.contains(pose)) {
        EXPECT_LE(seen.opacity, 0.0F) << "a scene that was seen is gone";
      }
    }
    seen_ = std::move(now);
    const auto body = animation.encode({}).subspan(wire::kSizePrefixBytes);
    EXPECT_TRUE(wire::fits(std::get<wire::Frame>(wire::decode(body).value()), animation.describe()));
  }

  /// What is on from the start does not fade in.
  void begin(Animation& animation) {
    for (std::size_t i = 0; i < animation.poses().size(); ++i) {
      seen_[animation.poses()[i]] = {joints_of(*animation.skeletons()[i], *animation.poses()[i]),
                                     animation.opacities()[i]};
    }
    remember_bounds(*animation.roster());
  }

  void change_to(Animation& animation, const settings::Config& next) {
    auto change = make_scene_change(*animation.roster(), next);
    remember_bounds(*change->roster);
    animation.begin_change(std::move(change));
  }

  void run_until_over(Animation& animation) {
    for (int tick = 0; tick < 3 * kFadeTicks; ++tick) {
      step(animation);
      if (auto finished = animation.take_finished_change()) return;
    }
    FAIL() << "the change does not come to an end";
  }

  void remember_bounds(const SceneRoster& roster) {
    for (const auto& staged : roster.scenes)
      bounds_m_[&staged->scene->pose()] = staged->scene->largest_joint_step_m(kChangeTick_s);
  }

  GustyWind wind_{{7.0, 2.0}, 1.5F};
  std::map<const pose::Pose*, Seen> seen_;
  std::map<const pose::Pose*, double> bounds_m_;
};

TEST_F(SceneChangeTest, WhatStaysMovesAsIfNothingHadChangedBitForBit) {
  std::vector<std::string> scenes = small_scenes();
  Animation changing = animation_of(config_of(scenes));
  Animation steady = animation_of(config_of(scenes));
  begin(changing);
  const auto step_both = [&] {
    const wind::ground::DrivingWind wind = blow();
    step(changing, wind);
    steady.step(wind, kChangeTick_s);
  };
  for (int tick = 0; tick < 60; ++tick) step_both();

  // The curtain is made anew elsewhere, the fire goes, a second meadow comes.
  scenes[1] = "kind = \"curtain\"\nname = \"curtain\"\nx = 5\n";
  scenes[3] = "kind = \"grass\"\nname = \"bank\"\nz = -9\nblades_across = 7\nblades_deep = 5\n";
  change_to(changing, config_of(scenes));
  EXPECT_THAT(names_of(changing), ElementsAre("meadow", "curtain", "flag", "bank", "curtain", "fire"));
  for (int tick = 0; tick < kFadeTicks; ++tick) {
    step_both();
    for (const std::size_t kept : {0U, 2U}) {
      ASSERT_EQ(pose::pose_hash(pose::kPoseHashSeed, *changing.poses()[kept]),
                pose::pose_hash(pose::kPoseHashSeed, *steady.poses()[kept]));
      ASSERT_EQ(changing.opacities()[kept], 1.0F);
    }
    ASSERT_EQ(changing.opacities().size(), 6U);
    ASSERT_NEAR(changing.opacities()[1] + changing.opacities()[4], 1.0F, 1e-6F) << "a cross-fade";
    if (changing.opacities()[4] > 0.0F) {
      ASSERT_EQ(pose::pose_hash(pose::kPoseHashSeed, *changing.poses()[4]),
                pose::pose_hash(pose::kPoseHashSeed, *steady.poses()[1]))
          << "what leaves moves on, too";
    }
  }
  run_until_over(changing);
  EXPECT_THAT(names_of(changing), ElementsAre("meadow", "curtain", "flag", "bank"));
  EXPECT_EQ(changing.generation(), 2U);
  EXPECT_THAT(changing.opacities(), ElementsAre(1.0F, 1.0F, 1.0F, 1.0F));
}

TEST_F(SceneChangeTest, AMovedListKeepsItsScenesUnderTheirNewNumbersAndNames) {
  // The seed moves by one as the first scene goes, so that the others have the seeds that they had.
  Animation animation = animation_of(config_of(small_scenes()));
  begin(animation);
  step(animation);
  const std::vector<const pose::Pose*> before(animation.poses().begin(), animation.poses().end());
  std::vector<std::string> rest = small_scenes();
  rest.erase(rest.begin());
  rest[0] = "kind = \"curtain\"\nname = \"drape\"\nx = 3\ncolumns = 40\nrows = 30\n";
  settings::Config next = config_of(rest);
  next.seed += 1;
  change_to(animation, next);
  EXPECT_EQ(std::vector(animation.poses().begin(), animation.poses().end()),
            (std::vector{before[1], before[2], before[3], before[0]}));
  run_until_over(animation);
  EXPECT_THAT(names_of(animation), ElementsAre("drape", "flag", "fire"));
}

TEST_F(SceneChangeTest, AGainIsOnlySetAndClientsAreToldNothing) {
  std::vector<std::string> scenes = small_scenes();
  Animation animation = animation_of(config_of(scenes));
  begin(animation);
  for (int tick = 0; tick < 30; ++tick) step(animation);
  const pose::Pose* const meadow = animation.poses()[0];
  scenes[0] += "gain = 0\n";
  auto change = make_scene_change(*animation.roster(), config_of(scenes));
  EXPECT_TRUE(change->messages.empty());
  EXPECT_EQ(change->kept, 4U);
  animation.begin_change(std::move(change));
  step(animation);
  EXPECT_NE(animation.take_finished_change(), nullptr);
  EXPECT_EQ(animation.generation(), 0U);
  EXPECT_EQ(animation.poses()[0], meadow);
  EXPECT_THAT(animation.opacities(), ElementsAre(1.0F, 1.0F, 1.0F, 1.0F));
  for (int tick = 0; tick < 60 * 60; ++tick) animation.step(blow(), kChangeTick_s);
  float bend_rad = 0.0F;
  pose::for_each_array(*meadow, [&](std::span<const float> values) {
    for (const float value : values) bend_rad = std::max(bend_rad, std::abs(value));
  });
  EXPECT_LT(bend_rad, 1e-3F) << "without wind it comes to rest";
}

TEST_F(SceneChangeTest, WhatIsShownStaysShownUnlessTheConfigurationSaysOtherwise) {
  std::vector<std::string> scenes = small_scenes();
  scenes[2] += "shown = false\n";
  const settings::Config config = config_of(scenes);
  Animation animation = animation_of(config);
  SceneDirector director(config, [&](const SceneCue& cue) {
    animation.cue(cue);
    return true;
  });
  begin(animation);
  // Somebody hid the meadow and the curtain, and shows the flag.
  director.handle({.scene = "meadow", .shown = false, .over_s = 2.0}, true);
  director.handle({.scene = "curtain", .shown = false, .over_s = 2.0}, true);
  director.handle({.scene = "flag", .shown = true, .over_s = 2.0}, true);
  for (int tick = 0; tick < kFadeTicks + 1; ++tick) step(animation);

  // The meadow is made anew, the curtain stays, the flag is made anew; the configuration now hides the fire.
  scenes[0] = "kind = \"grass\"\nname = \"meadow\"\nblades_across = 9\nblades_deep = 6\n";
  scenes[2] = "kind = \"flag\"\nname = \"flag\"\nz = 5\nshown = false\n";
  scenes[3] += "shown = false\n";
  auto change = make_scene_change(*animation.roster(), config_of(scenes));
  director.follow(*change->roster);
  EXPECT_EQ(change->kept, 2U);
  EXPECT_EQ(change->made, 2U);
  remember_bounds(*change->roster);
  animation.begin_change(std::move(change));
  run_until_over(animation);
  for (int tick = 0; tick < kFadeTicks; ++tick) step(animation);
  EXPECT_THAT(animation.opacities(), ElementsAre(0.0F, 0.0F, 1.0F, 0.0F));
  std::vector<bool> shown;
  for (const wire::SceneState& scene : director.handle({.scene = ""}, true).scenes) shown.push_back(scene.shown);
  EXPECT_THAT(shown, ElementsAre(false, false, true, false)) << "the director knows it";
}

TEST_F(SceneChangeTest, ScenesThatExchangeTheirNamesExchangeWhetherTheyAreShown) {
  std::vector<std::string> scenes = {"kind = \"curtain\"\nname = \"a\"\n",
                                     "kind = \"flag\"\nname = \"b\"\nshown = false\n"};
  Animation animation = animation_of(config_of(scenes));
  begin(animation);
  step(animation);
  scenes = {"kind = \"curtain\"\nname = \"b\"\nshown = false\n", "kind = \"flag\"\nname = \"a\"\n"};
  change_to(animation, config_of(scenes));
  for (int tick = 0; tick <= kFadeTicks; ++tick) step(animation);
  EXPECT_THAT(animation.opacities(), ElementsAre(0.0F, 1.0F));
}

TEST_F(SceneChangeTest, CuesDuringAChangeAreForTheScenesAfterIt) {
  std::vector<std::string> scenes = small_scenes();
  Animation animation = animation_of(config_of(scenes));
  begin(animation);
  step(animation);
  scenes.erase(scenes.begin());  // all others get other seeds
  change_to(animation, config_of(scenes));
  for (int tick = 0; tick < 30; ++tick) step(animation);
  animation.cue({.scene = 1, .shown = true, .hide_others = true, .over_s = 2.0});
  run_until_over(animation);
  for (int tick = 0; tick < kFadeTicks; ++tick) step(animation);
  EXPECT_THAT(names_of(animation), ElementsAre("curtain", "flag", "fire"));
  EXPECT_THAT(animation.opacities(), ElementsAre(0.0F, 1.0F, 0.0F));
}

std::vector<std::string> many_scenes(std::size_t count, const std::string& name) {
  std::vector<std::string> scenes;
  for (std::size_t i = 0; i < count; ++i) {
    scenes.push_back("kind = \"grass\"\nblades_across = 2\nblades_deep = 2\nname = \"" + name + std::to_string(i) +
                     "\"\nx = " + std::to_string(i) + "\n");
  }
  return scenes;
}

TEST_F(SceneChangeTest, WhereBothListsAreTooManyForTheStreamTheFirstFadesOutBeforeTheSecondComes) {
  Animation animation = animation_of(config_of(many_scenes(40, "old")));
  begin(animation);
  step(animation);
  std::vector<std::string> next = many_scenes(41, "new");
  for (std::size_t i = 1; i < next.size(); ++i) next[i] += "z = 1\n";  // the first stays
  change_to(animation, config_of(next));
  for (int tick = 0; tick < kFadeTicks; ++tick) {
    step(animation);
    ASSERT_EQ(animation.generation(), 0U);
    ASSERT_EQ(animation.poses().size(), 40U);
  }
  EXPECT_THAT(animation.opacities().subspan(0, 3), ElementsAre(1.0F, 0.0F, 0.0F));
  animation.cue({.scene = 40, .shown = false, .over_s = 0.0});  // a scene that is still to come
  step(animation);
  EXPECT_EQ(animation.generation(), 1U);
  ASSERT_EQ(animation.poses().size(), 41U);
  EXPECT_NE(animation.take_finished_change(), nullptr);
  for (int tick = 0; tick < kFadeTicks; ++tick) step(animation);
  std::vector<float> shown(41, 1.0F);
  shown[40] = 0.0F;
  EXPECT_EQ(std::vector(animation.opacities().begin(), animation.opacities().end()), shown);
}

TEST_F(SceneChangeTest, ScenesThatNoClientTakesAreRefusedBeforeAnythingChanges) {
  const Animation animation = animation_of(config_of(small_scenes()));
  settings::Config next = config_of(many_scenes(64, "new"));
  next.scenes.push_back(next.scenes.back());
  try {
    make_scene_change(*animation.roster(), next);
    FAIL() << "65 scenes were taken";
  } catch (const settings::ConfigError& error) {
    EXPECT_THAT(error.what(), HasSubstr("64 scenes"));
  }
  EXPECT_EQ(animation.generation(), 0U);
}

TEST_F(SceneChangeTest, ClientsAreSentTheListsThatTheFramesAreOf) {
  std::vector<std::string> scenes = small_scenes();
  Animation animation = animation_of(config_of(scenes));
  begin(animation);
  scenes.pop_back();
  auto change = make_scene_change(*animation.roster(), config_of(scenes));
  const std::vector<SceneChange::Message> messages = change->messages;
  ASSERT_EQ(messages.size(), 2U);
  EXPECT_GT(change->reach_m, 0.0);
  EXPECT_GT(change->node_count, 0U);
  EXPECT_EQ(change->leaving_count, 1U);
  remember_bounds(*change->roster);
  animation.begin_change(std::move(change));
  std::size_t list = 0;
  for (int tick = 0; tick < 2 * kFadeTicks; ++tick) {
    step(animation);
    if (list == 0 && animation.generation() == messages[1].generation) list = 1;
    ASSERT_EQ(animation.generation(), messages[list].generation);
    const auto sent = wire::decode(std::span(*messages[list].bytes).subspan(wire::kSizePrefixBytes));
    const auto frame = wire::decode(animation.encode({}).subspan(wire::kSizePrefixBytes));
    ASSERT_TRUE(wire::fits(std::get<wire::Frame>(frame.value()), std::get<wire::Scenes>(sent.value())));
  }
  EXPECT_EQ(list, 1U);
}

}  // namespace
}  // namespace yuragi::daemon::animation
