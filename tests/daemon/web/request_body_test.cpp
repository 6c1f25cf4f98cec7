#include "daemon/web/request_body.hpp"

#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace yuragi::daemon::web {
namespace {

using testing::HasSubstr;

std::string mistake_in_scene(std::string_view json) {
  const auto control = scene_control_of(json);
  return control ? "none" : control.error().message;
}
std::string mistake_in_player(std::string_view json) {
  const auto command = player_command_of(json);
  return command ? "none" : command.error().message;
}

TEST(SceneBody, AllKeysAndDefaults) {
  const auto all = scene_control_of(R"({"scene":"meadow","shown":false,"hide_others":true,"over_s":0.5})");
  ASSERT_TRUE(all);
  EXPECT_EQ(all->scene, "meadow");
  EXPECT_FALSE(all->shown);
  EXPECT_TRUE(all->hide_others);
  EXPECT_EQ(all->over_s, 0.5);

  const auto least = scene_control_of(R"({"scene":"meadow"})");
  ASSERT_TRUE(least);
  EXPECT_TRUE(least->shown);
  EXPECT_FALSE(least->hide_others);
  EXPECT_EQ(least->over_s, wire::Control{}.over_s);
}
TEST(SceneBody, MistakesNameTheirKey) {
  EXPECT_THAT(mistake_in_scene(""), HasSubstr("JSON object"));
  EXPECT_THAT(mistake_in_scene("[1]"), HasSubstr("JSON object"));
  EXPECT_THAT(mistake_in_scene(R"({"scene":"a")"), HasSubstr("JSON object"));
  EXPECT_THAT(mistake_in_scene("{}"), HasSubstr("scene: is missing"));
  EXPECT_THAT(mistake_in_scene(R"({"scene":1})"), HasSubstr("scene: must be a text"));
  EXPECT_THAT(mistake_in_scene(R"({"scene":"a","shown":"no"})"), HasSubstr("shown: must be true or false"));
  EXPECT_THAT(mistake_in_scene(R"({"scene":"a","over_s":-1})"), HasSubstr("over_s: must be a number from 0 to 3600"));
  EXPECT_THAT(mistake_in_scene(R"({"scene":"a","over_s":1e400})"), HasSubstr("JSON object"));
  EXPECT_THAT(mistake_in_scene(R"({"scene":"a","shon":true})"), HasSubstr("shon: is not known here"));
  EXPECT_THAT(mistake_in_scene(R"({"scene":")" + std::string(2000, 'a') + "\"}"), HasSubstr("at most 1024 bytes"));
}
TEST(SceneBody, DeepNestingCostsNothing) {
  EXPECT_NE(mistake_in_scene(R"({"scene":)" + std::string(30'000, '[') + std::string(30'000, ']') + "}"), "none");
}

TEST(PlayerBody, EveryAction) {
  EXPECT_EQ(player_command_of(R"({"action":"pause"})")->action, wire::PlayerAction::kPause);
  EXPECT_EQ(player_command_of(R"({"action":"resume","sensor":"roof"})")->sensor, "roof");
  EXPECT_EQ(player_command_of(R"({"action":"step","count":3})")->count, 3U);
  EXPECT_EQ(player_command_of(R"({"action":"seek","place":"+30"})")->place, "+30");
  EXPECT_EQ(player_command_of(R"({"action":"rate","rate":4})")->rate, 4.0);
}
TEST(PlayerBody, MistakesNameTheirKey) {
  EXPECT_THAT(mistake_in_player("{}"), HasSubstr("action: must be pause"));
  EXPECT_THAT(mistake_in_player(R"({"action":"fly"})"), HasSubstr("action: must be pause"));
  EXPECT_THAT(mistake_in_player(R"({"action":"step","count":0})"), HasSubstr("count: must be a number from 1"));
  EXPECT_THAT(mistake_in_player(R"({"action":"rate","rate":1e9})"), HasSubstr("rate: must be a number"));
}

TEST(ParameterBody, MistakesNameTheirKey) {
  const auto mistake = [](std::string_view json) {
    const auto command = parameter_command_of(json);
    return command ? "none" : command.error().message;
  };
  EXPECT_THAT(mistake("{}"), HasSubstr("set: is missing"));
  EXPECT_THAT(mistake(R"({"set": []})"), HasSubstr("set: must be an object"));
  EXPECT_THAT(mistake(R"({"set": {"a": null}})"), HasSubstr("set: must be an object of at most 64"));
  EXPECT_THAT(mistake(R"({"set": {"a": {"b": 1}}})"), HasSubstr("set: must be"));
  EXPECT_THAT(mistake(R"({"set": {"a": ")" + std::string(2000, 'a') + "\"}}"), HasSubstr("set: must be"));
  EXPECT_THAT(mistake(R"({"reset": [1]})"), HasSubstr("reset: must be a list"));
  EXPECT_EQ(mistake(R"({"set": {"a": 1}})"), "none");
}
TEST(HandBody, AllKeysAndDefaults) {
  const auto wind = wind_by_hand_of(R"({"speed_m_s":8,"direction_deg":270})");
  ASSERT_TRUE(wind);
  EXPECT_EQ(wind->part, wire::HandPart::kWind);
  EXPECT_EQ(wind->speed_m_s, 8.0);
  EXPECT_EQ(wind->direction_deg, 270.0);
  EXPECT_EQ(wind->for_s, 60.0);
  EXPECT_TRUE(wind_by_hand_of(R"({"release":true})")->is_release);
  EXPECT_EQ(blackout_of("{}")->for_s, 3600.0);
  EXPECT_EQ(blackout_of(R"({"for_s":null})")->for_s, std::nullopt);
  EXPECT_EQ(camera_of(R"({"camera":"gate","for_s":90})")->camera, "gate");
  EXPECT_TRUE(camera_of(R"({"release":true})")->is_release);
}
TEST(HandBody, MistakesNameTheirKey) {
  const auto mistake = [](const auto& command) { return command ? "none" : command.error().message; };
  EXPECT_THAT(mistake(wind_by_hand_of("{}")), HasSubstr("speed_m_s: is missing"));
  EXPECT_THAT(mistake(wind_by_hand_of(R"({"speed_m_s":8})")), HasSubstr("direction_deg: is missing"));
  EXPECT_THAT(mistake(wind_by_hand_of(R"({"speed_m_s":-1,"direction_deg":0})")), HasSubstr("speed_m_s: must be"));
  EXPECT_THAT(mistake(wind_by_hand_of(R"({"speed_m_s":1e300,"direction_deg":0})")), HasSubstr("speed_m_s: must be"));
  EXPECT_THAT(mistake(wind_by_hand_of(R"({"speed_m_s":1,"direction_deg":361})")), HasSubstr("direction_deg: must be"));
  EXPECT_THAT(mistake(wind_by_hand_of(R"({"speed_m_s":1,"direction_deg":0,"for_s":3601})")), HasSubstr("for_s: must"));
  EXPECT_THAT(mistake(wind_by_hand_of(R"({"speed_m_s":1,"direction_deg":0,"for_s":null})")), HasSubstr("for_s: must"));
  EXPECT_THAT(mistake(blackout_of(R"({"for_s":0})")), HasSubstr("for_s: must be a number from 1 to 86400"));
  EXPECT_THAT(mistake(blackout_of(R"({"camera":"gate"})")), HasSubstr("camera: is not known here"));
  EXPECT_THAT(mistake(blackout_of("[")), HasSubstr("JSON object"));
  EXPECT_THAT(mistake(camera_of("{}")), HasSubstr("camera: is missing"));
}
TEST(CalibrationBody, EachCalibrationTakesWhatIsKnown) {
  EXPECT_EQ(calibration_order_of(R"({"calibration":"zero","for_s":30})")->duration_s, 30.0);
  EXPECT_EQ(calibration_order_of(R"({"calibration":"north","bearing_deg":214})")->bearing_deg, 214.0);
  EXPECT_EQ(calibration_order_of(R"({"calibration":"span","reference":"mast"})")->reference, "mast");
  EXPECT_EQ(calibration_order_of(R"({"calibration":"span","speed_m_s":3})")->speed_m_s, 3.0);
  EXPECT_EQ(calibration_order_of(R"({"calibration":"span","points":"3.1:3 10.4:11"})")->points.size(), 2U);
  EXPECT_EQ(calibration_order_of(R"({"calibration":"microphone","reference":"mast"})")->reference, "mast");
  EXPECT_EQ(calibration_order_of(R"({"calibration":"microphone","speed_m_s":3})")->speed_m_s, 3.0);
  EXPECT_EQ(calibration_order_of(R"({"calibration":"microphone","points":"3.1:3 10.4:11"})")->points.size(), 2U);
  for (const char* const mistaken :
       {"{}", R"({"calibration":"microphone"})", R"({"calibration":"microphone","bearing_deg":3})",
        R"({"calibration":"microphone","speed_m_s":3,"reference":"mast"})", R"({"calibration":"--yes"})",
        R"({"calibration":"zero","reference":"mast"})", R"({"calibration":"north"})",
        R"({"calibration":"north","bearing_deg":361})", R"({"calibration":"north","bearing_deg":"214"})",
        R"({"calibration":"north","bearing_deg":1,"reference":"mast"})", R"({"calibration":"span","bearing_deg":1})",
        R"({"calibration":"span","speed_m_s":0})", R"({"calibration":"span","points":"3.1:3; reboot"})",
        R"({"calibration":"zero","for_s":1801})", R"({"calibration":"zero","recording":"/etc/passwd"})"})
    EXPECT_FALSE(calibration_order_of(mistaken)) << mistaken;
}
TEST(CalibrationBody, WhatIsKeptHasTheValuesBefore) {
  const auto found =
      found_calibration_of(R"({"before":{"gain":1,"curve":""},"after":{"gain":1.04,"curve":"0:0 5:6"}})");
  ASSERT_TRUE(found);
  EXPECT_EQ(found->after, (FoundCalibration::Values{{"curve", "0:0 5:6"}, {"gain", "1.04"}}));
  for (const char* const mistaken :
       {"{}", R"({"before":{},"after":{}})", R"({"after":{"gain":2}})", R"({"before":{"gain":1},"after":{"offset":2}})",
        R"({"before":{"gain":1},"after":{"gain":[2]}})", R"({"before":{"gain":1},"after":{"gain":2},"file":"a"})"})
    EXPECT_FALSE(found_calibration_of(mistaken)) << mistaken;
}
TEST(SocketBody, AllKeysAndDefaults) {
  const auto all =
      socket_wish_of(R"({"wind":60,"status":2,"places":["door"],"stream":{"scenes":["flag"],"every":8,"rate":30}})");
  ASSERT_TRUE(all);
  EXPECT_EQ(all->wind_hz, 60.0);
  EXPECT_EQ(all->status_hz, 2.0);
  EXPECT_EQ(all->places, std::vector<std::string>{"door"});
  ASSERT_TRUE(all->stream);
  EXPECT_EQ(all->stream->thinning.every, 8U);
  EXPECT_EQ(all->stream->rate_hz, 30.0);
  const auto none = socket_wish_of("{}");
  ASSERT_TRUE(none);
  EXPECT_FALSE(none->stream);
}

TEST(KeptBody, ValuesOfLookAndOfScenes) {
  const auto all = kept_values_of(R"({"look":{"haze":0.5},"scenes":{"elm":{"gain":2,"shown":false}}})");
  ASSERT_TRUE(all) << all.error().message;
  ASSERT_EQ(all->size(), 3U);
  EXPECT_EQ(all->at(0).scene + "." + all->at(0).key + "=" + *all->at(0).value, ".haze=0.5");
  EXPECT_EQ(all->at(2).scene + "." + all->at(2).key + "=" + *all->at(2).value, "elm.shown=false");
}
TEST(KeptBody, MistakesNameTheirKey) {
  const auto mistake = [](std::string_view json) {
    const auto values = kept_values_of(json);
    return values ? "none" : values.error().message;
  };
  EXPECT_THAT(mistake("{}"), HasSubstr("are missing"));
  EXPECT_THAT(mistake(R"({"look":1})"), HasSubstr("look: must be an object"));
  EXPECT_THAT(mistake(R"({"look":{"haze":[1]}})"), HasSubstr("look: must be an object"));
  EXPECT_THAT(mistake(R"({"scenes":{"elm":1}})"), HasSubstr("scenes: elm: must be an object"));
  EXPECT_THAT(mistake(R"({"scenes":{"":{"haze":1}}})"), HasSubstr("scenes: a scene has no name"));
  EXPECT_THAT(mistake(R"({"sensor":{}})"), testing::AnyOf(HasSubstr("missing"), HasSubstr("sensor")));
}

}  // namespace
}  // namespace yuragi::daemon::web
