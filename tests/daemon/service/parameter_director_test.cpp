#include "daemon/service/parameter_director.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "daemon/service/parameter_groups.hpp"
#include "tests/daemon/service/work_queue.hpp"

namespace yuragi::daemon::service {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr const char* kFile =
    "[look]\nhaze = 0.2\n"
    "[[scene]]\nkind = \"flag\"\nname = \"banner\"\ngain = 1.5\n"
    "[[scene]]\nkind = \"grass\"\nblades_across = 8\nblades_deep = 8\n";

class ParameterTest : public ::testing::Test {
 protected:
  ReloadParts parts() {
    ReloadParts parts{.post = [this](std::function<void()> work) { queue_.post(std::move(work)); },
                      .file = "/etc/wall.toml",
                      .read = [this] { return settings::parse_config(text_, "wall.toml"); },
                      .make_scenes = [this](const settings::Config& next, const auto&) -> ReloadParts::Adopt {
                        if (next.scenes.at(0).placement.x_m > 900.0)
                          throw settings::ConfigError("[[scene]]: too large");
                        return [this] { ++adopted_; };
                      },
                      .apply = [this](const settings::ReloadPlan& plan) { applied_.push_back(plan.next); },
                      .apply_edits = [this](const settings::ReloadPlan& plan) { edited_.push_back(plan.next); }};
    parts.is_settling = [this] { return is_settling_; };
    return parts;
  }

  /// Sends the command; the reply comes into replies_, of a change when queue_.do_one() was called.
  void send(const std::string& scene, std::vector<wire::ParameterEdit> edits, bool is_local = true) {
    director_.handle({.scene = scene, .edits = std::move(edits), .number = ++number_}, is_local,
                     [this](const wire::ControlReply& reply) { replies_.push_back(reply); });
  }
  std::string refusal_of(const std::string& scene, const std::string& key, std::optional<std::string> value) {
    send(scene, {{key, std::move(value)}});
    EXPECT_FALSE(replies_.back().done);
    return replies_.back().message;
  }

  wire::ParameterState listed(const std::string& scene, const std::string& key, bool is_local = true) {
    wire::ControlReply reply;
    director_.handle({.describe = true}, is_local, [&reply](const wire::ControlReply& made) { reply = made; });
    for (const wire::ParameterGroup& group : reply.parameters->groups) {
      for (const wire::ParameterState& state : group.parameters) {
        if (group.scene == scene && state.name == key) return state;
      }
    }
    ADD_FAILURE() << scene << "." << key << " is not listed";
    return {};
  }

  WorkQueue queue_;
  std::string text_ = kFile;
  bool is_settling_ = false;
  int adopted_ = 0;
  std::vector<settings::Config> applied_, edited_;
  std::vector<animation::SceneCue> cues_;
  std::vector<wire::ControlReply> replies_;
  std::uint32_t number_ = 0;
  settings::Config config_ = settings::parse_config(kFile, "wall.toml");
  animation::SceneDirector scenes_{config_, [this](const animation::SceneCue& cue) {
                                     cues_.push_back(cue);
                                     return true;
                                   }};
  Reload reload_{config_, parts()};
  ParameterDirector director_{reload_, &scenes_, settings::ControlPermission::kLoopback, 1};
};

TEST_F(ParameterTest, EveryParameterIsListedAsItsTableDescribesIt) {
  wire::ControlReply reply;
  director_.handle({.describe = true, .number = 9}, false, [&reply](const auto& made) { reply = made; });
  ASSERT_TRUE(reply.done && reply.parameters);
  EXPECT_EQ(reply.parameters->number, 9U);
  EXPECT_THAT(reply.parameters->refusal, HasSubstr("values cannot be set from here"));
  ASSERT_EQ(reply.parameters->groups.size(), 3U);
  EXPECT_EQ(reply.parameters->groups[0].parameters.size(), look::look_parameters().size());
  EXPECT_EQ(reply.parameters->groups[1].scene, "banner");
  EXPECT_EQ(reply.parameters->groups[1].kind, "flag");
  for (std::size_t i = 0; i < config_.scenes.size(); ++i) {
    EXPECT_EQ(reply.parameters->groups[i + 1].parameters.size(),
              settings::scene_parameters(*config_.scenes[i].kind).size());
  }

  const wire::ParameterState haze = listed("", "haze");
  EXPECT_EQ(haze.kind, wire::ParameterKind::kNumber);
  EXPECT_EQ(haze.min, 0.0);
  EXPECT_EQ(haze.max, 1.0);
  EXPECT_EQ(haze.value, "0.2");
  EXPECT_EQ(haze.configured, "0.2");
  EXPECT_EQ(haze.default_value, "0.15");
  EXPECT_EQ(haze.change, KeyChange::kAtOnce);
  const wire::ParameterState sun = listed("", "sun");
  EXPECT_EQ(sun.value, std::nullopt);
  EXPECT_THAT(sun.left_out, HasSubstr("evening"));
  EXPECT_FALSE(sun.choices.empty());
  EXPECT_EQ(listed("", "ground_image").change, KeyChange::kTakesReload);
  EXPECT_EQ(listed("banner", "gain").change, KeyChange::kAtOnce);
  EXPECT_EQ(listed("banner", "shown").kind, wire::ParameterKind::kYesNo);
  EXPECT_EQ(listed("grass", "blades_across").kind, wire::ParameterKind::kWholeNumber);
  EXPECT_EQ(listed("grass", "blades_across").change, KeyChange::kCrossFade);
}

TEST_F(ParameterTest, WhatIsSetLastsUntilTheFileIsReadAgain) {
  send("", {{"haze", "0.4"}, {"time", "06:30"}});
  EXPECT_THAT(replies_, IsEmpty()) << "not before it is done";
  queue_.do_one();
  ASSERT_EQ(replies_.size(), 1U);
  EXPECT_TRUE(replies_[0].done);
  EXPECT_EQ(replies_[0].message,
            "[look] haze: 0.2 -> 0.4; [look] time: left out -> \"06:30\" (until the configuration is read again)");
  EXPECT_EQ(replies_[0].parameters->number, 1U);
  EXPECT_THAT(replies_[0].parameters->groups, IsEmpty());
  ASSERT_EQ(edited_.size(), 1U);
  EXPECT_EQ(edited_[0].look.haze, 0.4);
  EXPECT_EQ(edited_[0].look.sun, look::SunChoice::kTime);
  EXPECT_THAT(applied_, IsEmpty()) << "no new session of a recording";
  EXPECT_EQ(listed("", "haze").value, "0.4");
  EXPECT_EQ(listed("", "haze").configured, "0.2");

  send("", {{"time", std::nullopt}});
  queue_.do_one();
  EXPECT_EQ(edited_.back().look.solar_time_h, std::nullopt);
  EXPECT_EQ(listed("", "time").value, std::nullopt);
  EXPECT_EQ(listed("", "haze").value, "0.4") << "the other one stays";

  reload_.request();
  EXPECT_TRUE(reload_.is_under_way());
  queue_.do_one();
  EXPECT_EQ(applied_.back().look.haze, 0.2);
  EXPECT_EQ(listed("", "haze").value, "0.2");
}

TEST_F(ParameterTest, AMistakeChangesNothingAndIsToldAsOfTheFile) {
  const auto of_file = [](const std::string& text) {
    try {
      settings::parse_config(text, "wall.toml");
    } catch (const settings::ConfigError& error) {
      return std::string(error.what());
    }
    return std::string("no mistake");
  };
  EXPECT_THAT(of_file("[look]\nhaze = 3.0\n"), HasSubstr(refusal_of("", "haze", "3")));
  EXPECT_THAT(refusal_of("", "haze", "3"), HasSubstr("look.haze: is 3; allowed: number from 0 to 1"));
  EXPECT_THAT(of_file("[look]\nhaze = \"much\"\n"), HasSubstr(refusal_of("", "haze", "much")));
  EXPECT_THAT(of_file("[look]\nsun = \"west\"\n"), HasSubstr(refusal_of("", "sun", "west")));
  EXPECT_THAT(of_file("[look]\ntime = \"25:00\"\n"), HasSubstr(refusal_of("", "time", "25:00")));
  EXPECT_THAT(of_file("[look]\nmist = \"1\"\n"), HasSubstr(refusal_of("", "mist", "1")));
  EXPECT_THAT(refusal_of("", "mist", std::nullopt), HasSubstr("look.mist: is not a known key here"));
  EXPECT_THAT(of_file("[[scene]]\nkind = \"flag\"\ngain = -1.0\n"), HasSubstr(refusal_of("banner", "gain", "-1")));
  EXPECT_THAT(refusal_of("grass", "blades_across", "8.5"), HasSubstr("scene.blades_across: is a text (\"8.5\")"));
  EXPECT_THAT(refusal_of("grass", "shown", "perhaps"), HasSubstr("scene.shown: "));
  EXPECT_THAT(refusal_of("pond", "gain", "1"), HasSubstr("there is no scene \"pond\"; there are: banner, grass"));
  EXPECT_THAT(refusal_of("grass", "name", "lawn"), HasSubstr("scene.name: is not a known key here"));

  send("", {{"clouds", "1"}, {"haze", "nan"}});
  EXPECT_FALSE(replies_.back().done);
  EXPECT_EQ(listed("", "clouds").value, "0.3") << "all of them, or none";
  EXPECT_THAT(edited_, IsEmpty());
  EXPECT_THAT(cues_, IsEmpty());
}

TEST_F(ParameterTest, ScenesThatCannotBeMadeChangeNothing) {
  send("banner", {{"x", "999"}});
  queue_.do_one();
  ASSERT_EQ(replies_.size(), 1U);
  EXPECT_FALSE(replies_[0].done);
  EXPECT_EQ(replies_[0].message, "nothing was changed: [[scene]]: too large");
  EXPECT_EQ(listed("banner", "x").value, "0");
  send("banner", {{"x", "9"}});
  queue_.do_one();
  EXPECT_TRUE(replies_[1].done);
  EXPECT_EQ(adopted_, 1);
}

TEST_F(ParameterTest, WhoMaySetIsWhoMayControl) {
  send("", {{"haze", "0.4"}}, false);
  ASSERT_EQ(replies_.size(), 1U);
  EXPECT_FALSE(replies_[0].done);
  EXPECT_THAT(replies_[0].message, HasSubstr("[stream] control = \"loopback\""));
  EXPECT_EQ(replies_[0].parameters->refusal, replies_[0].message);
  director_.allow(settings::ControlPermission::kNobody);
  EXPECT_THAT(refusal_of("", "haze", "0.4"), HasSubstr("[stream] control = \"nobody\""));
  director_.allow(settings::ControlPermission::kAnywhere);
  send("", {{"haze", "0.4"}}, false);
  queue_.do_one();
  EXPECT_TRUE(replies_.back().done);
}

TEST_F(ParameterTest, AScenesShownIsSwitchedAsByAnyOtherClient) {
  scenes_.handle({.scene = "banner", .shown = false}, true);
  EXPECT_EQ(listed("banner", "shown").value, "false") << "what is so, not what the file began with";
  const std::uint64_t revision = director_.revision();
  send("banner", {{"shown", std::nullopt}});
  ASSERT_EQ(replies_.size(), 1U) << "at once";
  EXPECT_EQ(replies_[0].message, "banner is shown, over 2 s (until the configuration is read again)");
  EXPECT_TRUE(cues_.back().shown);
  EXPECT_NE(director_.revision(), revision);
  send("banner", {{"shown", "false"}, {"gain", "2"}});
  queue_.do_one();
  EXPECT_FALSE(cues_.back().shown);
  EXPECT_EQ(edited_.back().scenes.at(0).wind_gain, 2.0);
  EXPECT_TRUE(edited_.back().scenes[0].is_shown) << "the file's";
}

TEST_F(ParameterTest, ValuesThatCameWhileScenesFadeAreSetTogetherAndTheLookDoesNotWait) {
  is_settling_ = true;
  send("banner", {{"gain", "2"}});
  send("banner", {{"gain", "3"}});
  send("banner", {{"gain", "2.5"}});
  send("grass", {{"x", "4"}});
  EXPECT_THAT(replies_, IsEmpty());
  send("", {{"haze", "0.9"}});
  queue_.do_one();
  ASSERT_EQ(replies_.size(), 1U);
  EXPECT_EQ(replies_[0].parameters->number, 5U);
  EXPECT_EQ(edited_.back().scenes.at(0).wind_gain, 1.5);
  is_settling_ = false;
  reload_.go_on();
  queue_.do_one();
  ASSERT_EQ(replies_.size(), 5U);
  EXPECT_EQ(edited_.size(), 2U) << "one change of the scenes";
  EXPECT_EQ(edited_.back().scenes[0].wind_gain, 2.5) << "the last one counts";
  EXPECT_EQ(edited_.back().scenes.at(1).placement.x_m, 4.0);
  EXPECT_EQ(edited_.back().look.haze, 0.9);
}

TEST_F(ParameterTest, AFileThatIsReadAfterAValueWasSetUndoesItAndOneBeforeDoesNot) {
  is_settling_ = true;
  send("banner", {{"gain", "2"}});
  reload_.request();
  send("grass", {{"x", "4"}});
  is_settling_ = false;
  reload_.go_on();
  for (int i = 0; i < 3; ++i) queue_.do_one();
  EXPECT_EQ(listed("banner", "gain").value, "1.5");
  EXPECT_EQ(listed("grass", "x").value, "4");
}

TEST_F(ParameterTest, AsManyClientsAsLikeCannotMakeItKeepThemAll) {
  is_settling_ = true;
  for (std::size_t i = 0; i < Reload::kMaxWaiting + 3; ++i) send("banner", {{"gain", "2"}});
  ASSERT_EQ(replies_.size(), 3U);
  EXPECT_THAT(replies_[0].message, HasSubstr("too many requests at once"));
}

TEST_F(ParameterTest, AClientOfAnotherMachineSeesNoFolders) {
  const wire::ParameterState image{.name = "image",
                                   .kind = wire::ParameterKind::kText,
                                   .value = "/home/anna/flag.png",
                                   .configured = "/srv/old.png"};
  const auto told = without_folders({{"banner", "flag", {image}}});
  EXPECT_EQ(told[0].parameters[0].value, "flag.png");
  EXPECT_EQ(told[0].parameters[0].configured, "old.png");
}

TEST(ParameterDirector, WithoutScenesThereIsTheLookAlone) {
  const settings::Config config = settings::default_config();
  Reload reload(config,
                {.post = [](const std::function<void()>&) {}, .file = {}, .read = {}, .make_scenes = {}, .apply = {}});
  ParameterDirector director(reload, nullptr, settings::ControlPermission::kLoopback, 1);
  std::vector<wire::ControlReply> replies;
  const auto keep = [&replies](const wire::ControlReply& reply) { replies.push_back(reply); };
  director.handle({.describe = true}, true, keep);
  EXPECT_EQ(replies.at(0).parameters->groups.size(), 1U);
  for (const char* key : {"gain", "shown"}) {
    director.handle({.scene = "grass", .edits = {{key, "1"}}}, true, keep);
    EXPECT_FALSE(replies.back().done);
    EXPECT_EQ(replies.back().message, "this daemon has no scenes");
  }
}

}  // namespace
}  // namespace yuragi::daemon::service
