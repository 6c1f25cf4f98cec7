#include "daemon/animation/scene_director.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace yuragi::daemon::animation {
namespace {

using ::testing::HasSubstr;

class SceneDirectorTest : public testing::Test {
 protected:
  SceneDirector director(const std::string& control) {
    const settings::Config config =
        settings::parse_config("[stream]\ncontrol = \"" + control +
                                   "\"\n[[scene]]\nkind = \"grass\"\nname = \"bank\"\n[[scene]]\nkind = "
                                   "\"grass\"\nname = \"meadow\"\nshown = false\n",
                               "test.toml");
    return {config, [this](const SceneCue& cue) {
              if (is_full_) return false;
              cues_.push_back(cue);
              return true;
            }};
  }

  std::vector<SceneCue> cues_;
  bool is_full_ = false;
};

TEST_F(SceneDirectorTest, HandsOnWhatItIsAskedForAndTellsHowThingsAre) {
  SceneDirector here = director("loopback");
  const auto reply = here.handle({.scene = "meadow", .shown = true, .hide_others = true, .over_s = 3.0}, true);
  EXPECT_TRUE(reply.done);
  EXPECT_EQ(reply.message, "meadow is shown, every other scene hidden, over 3 s");
  ASSERT_EQ(cues_.size(), 1U);
  EXPECT_EQ(cues_[0].scene, 1U);
  EXPECT_TRUE(cues_[0].shown);
  EXPECT_TRUE(cues_[0].hide_others);
  EXPECT_EQ(cues_[0].over_s, 3.0);
  ASSERT_EQ(reply.scenes.size(), 2U);
  EXPECT_EQ(reply.scenes[0].name, "bank");
  EXPECT_EQ(reply.scenes[0].kind, "grass");
  EXPECT_FALSE(reply.scenes[0].shown);
  EXPECT_TRUE(reply.scenes[1].shown);
}

TEST_F(SceneDirectorTest, TellsWithoutChangingAnythingWhereNoSceneIsNamed) {
  SceneDirector here = director("nobody");
  const auto reply = here.handle({.scene = ""}, false);
  EXPECT_TRUE(reply.done);
  EXPECT_TRUE(reply.scenes[0].shown);
  EXPECT_FALSE(reply.scenes[1].shown);
  EXPECT_TRUE(cues_.empty());
}

TEST_F(SceneDirectorTest, TakesItOnlyFromThoseWhoMay) {
  const wire::Control control{.scene = "meadow"};
  EXPECT_TRUE(director("loopback").handle(control, true).done);
  EXPECT_FALSE(director("loopback").handle(control, false).done);
  EXPECT_TRUE(director("anywhere").handle(control, false).done);
  EXPECT_FALSE(director("nobody").handle(control, true).done);
  EXPECT_EQ(cues_.size(), 2U);
  const auto refused = director("loopback").handle(control, false);
  EXPECT_FALSE(refused.scenes[1].shown) << "nothing has changed";
  EXPECT_THAT(refused.message, HasSubstr("control"));
}

TEST_F(SceneDirectorTest, SaysWhichScenesThereAreAndWhenThereIsNoRoom) {
  SceneDirector here = director("loopback");
  const auto unknown = here.handle({.scene = "forest"}, true);
  EXPECT_FALSE(unknown.done);
  EXPECT_THAT(unknown.message, HasSubstr("bank, meadow"));
  is_full_ = true;
  const auto full = here.handle({.scene = "meadow"}, true);
  EXPECT_FALSE(full.done);
  EXPECT_FALSE(full.scenes[1].shown);
}

}  // namespace
}  // namespace yuragi::daemon::animation
