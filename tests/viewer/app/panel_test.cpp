#include "viewer/app/panel.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace yuragi::viewer::app {
namespace {

using ::testing::HasSubstr;

/// A panel and a daemon that answers it when the test says so.
class PanelTest : public ::testing::Test {
 protected:
  PanelTest() { panel_.set_connected(true); }

  wire::ControlReply list(std::uint32_t number, const std::string& haze) const {
    const auto state = [](const char* name, const std::string& value) {
      return wire::ParameterState{.name = name, .min = 0.0, .max = 1.0, .value = value, .configured = "0.2"};
    };
    return {
        .done = true,
        .message = "nothing was changed",
        .scenes = {},
        .parameters = wire::ParameterReport{
            .number = number, .groups = {{"", "", {state("haze", haze)}}, {"elm", "tree", {state("gain", "0.5")}}}}};
  }
  static wire::ControlReply answer(const wire::Control& control, bool is_done, const std::string& message = "") {
    return {.done = is_done,
            .message = message,
            .scenes = {},
            .parameters = wire::ParameterReport{.number = control.parameters->number}};
  }
  /// What is sent at now_s, which has to be something.
  wire::Control sent(double now_s) {
    auto control = panel_.next(now_s);
    EXPECT_TRUE(control && control->parameters) << now_s;
    EXPECT_FALSE(control && !control->scene.empty()) << "an older daemon would show that scene";
    return control.value_or(wire::Control{.scene = "", .parameters = wire::ParameterCommand{}});
  }
  void get_list(double now_s, const std::string& haze = "0.2") {
    const wire::Control asked = sent(now_s);
    EXPECT_TRUE(asked.parameters->describe);
    EXPECT_TRUE(asked.parameters->edits.empty());
    panel_.take_reply(list(asked.parameters->number, haze));
  }
  std::string haze() const {
    return panel_.value(panel_.groups().at(0), panel_.groups()[0].parameters.at(0)).value_or("left out");
  }

  Panel panel_;
};

TEST_F(PanelTest, AsksForTheListOnceAndAgainWhenItHasChanged) {
  EXPECT_FALSE(panel_.has_list());
  panel_.take_revision(7);
  get_list(0.0);
  EXPECT_TRUE(panel_.has_list());
  panel_.take_revision(7);
  EXPECT_FALSE(panel_.next(10.0));
  panel_.take_revision(8);
  get_list(10.1, "0.3");
  EXPECT_EQ(haze(), "0.3");
  panel_.take_revision(9);
  EXPECT_FALSE(panel_.next(10.2)) << "not more often than twice a second";
  get_list(10.1 + Panel::kListEvery_s, "0.4");
}

TEST_F(PanelTest, ADragIsSentTenTimesASecondAndItsLastValueAlways) {
  get_list(0.0);
  int count = 0;
  std::string last = "0.2";
  // 1 s of pictures at 60 Hz, each with another value; the daemon answers at once.
  for (int picture = 0; picture <= 60; ++picture) {
    const double now_s = 10.0 + picture / 60.0;
    panel_.set("", "haze", std::to_string(picture));
    while (const auto control = panel_.next(now_s)) {
      if (control->parameters->describe) {
        panel_.take_reply(list(control->parameters->number, last));
        continue;
      }
      ++count;
      ASSERT_EQ(control->parameters->edits.size(), 1U);
      last = control->parameters->edits[0].value.value_or("");
      panel_.take_reply(answer(*control, true));
    }
    EXPECT_EQ(haze(), std::to_string(picture)) << "the handle stays under the mouse";
  }
  EXPECT_GE(count, 9);
  EXPECT_LE(count, 11);
  for (double now_s = 11.0; const auto control = panel_.next(now_s); now_s += 0.2) {
    if (!control->parameters->describe) last = control->parameters->edits[0].value.value_or("");
    panel_.take_reply(control->parameters->describe ? list(control->parameters->number, last) : answer(*control, true));
  }
  EXPECT_EQ(last, "60");
}

TEST_F(PanelTest, OfOneSceneOneCommandAtATimeIsOnItsWay) {
  get_list(0.0);
  panel_.set("elm", "gain", "0.6");
  const wire::Control first = sent(1.0);
  EXPECT_EQ(first.parameters->scene, "elm");
  panel_.set("elm", "gain", "0.7");
  panel_.set("elm", "gain", "0.8");
  EXPECT_FALSE(panel_.next(2.0)) << "the scene is still being made";
  panel_.set("", "haze", "0.9");
  EXPECT_EQ(sent(3.0).parameters->scene, "") << "others need not wait";
  panel_.take_reply(answer(first, true));
  const wire::Control second = sent(4.0);
  ASSERT_EQ(second.parameters->edits.size(), 1U);
  EXPECT_EQ(second.parameters->edits[0].value, "0.8");
}

TEST_F(PanelTest, WhatWasSetIsShownUntilTheListSaysSo) {
  get_list(0.0);
  panel_.set("", "haze", "0.7");
  const wire::Control set = sent(1.0);
  EXPECT_EQ(haze(), "0.7");
  panel_.take_reply(answer(set, true));
  EXPECT_EQ(haze(), "0.7") << "the list is older";
  get_list(2.0, "0.7");
  panel_.take_revision(1);
  get_list(3.0, "0.1");
  EXPECT_EQ(haze(), "0.1") << "set by somebody else since";
}

TEST_F(PanelTest, AListThatWasAskedForBeforeDoesNotPutTheHandleBack) {
  get_list(0.0);
  panel_.take_revision(1);
  const wire::Control asked = sent(1.0);
  EXPECT_TRUE(asked.parameters->describe);
  panel_.set("", "haze", "0.7");
  const wire::Control set = sent(1.1);
  panel_.take_reply(list(asked.parameters->number, "0.2"));
  EXPECT_EQ(haze(), "0.7");
  panel_.take_reply(answer(set, true));
  get_list(2.0, "0.7");
  EXPECT_EQ(haze(), "0.7");
}

TEST_F(PanelTest, ARefusalIsToldAndTheHandleGoesBack) {
  get_list(0.0);
  panel_.set("", "haze", "3");
  panel_.take_reply(answer(sent(1.0), false, "look.haze: is 3; allowed: number from 0 to 1"));
  EXPECT_THAT(panel_.mistake(), HasSubstr("allowed: number from 0 to 1"));
  EXPECT_EQ(haze(), "0.2");
  panel_.set("", "haze", "0.5");
  panel_.take_reply(answer(sent(2.0), true));
  EXPECT_EQ(panel_.mistake(), "");
}

TEST_F(PanelTest, AResetAsksForTheConfigurationsValue) {
  get_list(0.0, "0.9");
  panel_.reset("", "haze");
  EXPECT_EQ(haze(), "0.2");
  const wire::Control reset = sent(1.0);
  ASSERT_EQ(reset.parameters->edits.size(), 1U);
  EXPECT_EQ(reset.parameters->edits[0].key, "haze");
  EXPECT_EQ(reset.parameters->edits[0].value, std::nullopt);
}

TEST_F(PanelTest, WhoMayNotSetSendsNothing) {
  wire::ControlReply reply = list(sent(0.0).parameters->number, "0.2");
  reply.parameters->refusal = "values cannot be set from another machine";
  panel_.take_reply(reply);
  EXPECT_THAT(panel_.refusal(), HasSubstr("another machine"));
  panel_.set("", "haze", "0.5");
  EXPECT_EQ(haze(), "0.2");
  EXPECT_FALSE(panel_.next(10.0));
}

TEST_F(PanelTest, AnOlderDaemonIsToldToBeOne) {
  sent(0.0);
  panel_.take_reply({.done = true, .message = "nothing was changed", .scenes = {}});
  EXPECT_THAT(panel_.refusal(), HasSubstr("older version"));
  EXPECT_FALSE(panel_.next(10.0));
}

TEST_F(PanelTest, ANewConnectionBeginsAnew) {
  get_list(0.0);
  panel_.set("", "haze", "0.5");
  sent(1.0);
  panel_.set_connected(false);
  EXPECT_FALSE(panel_.has_list());
  EXPECT_FALSE(panel_.next(2.0));
  panel_.set("", "haze", "0.6");
  panel_.set_connected(true);
  get_list(2.1);
  EXPECT_EQ(haze(), "0.2");
  EXPECT_FALSE(panel_.next(10.0)) << "what was set before is forgotten";
}

}  // namespace
}  // namespace yuragi::viewer::app
