#include "engine/output/output_tables.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace yuragi::output {
namespace {

using testing::HasSubstr;

std::string mistake_in(const std::string& text) {
  const auto outputs = parse_outputs(text, "wall.toml");
  return outputs ? std::string() : outputs.error().message;
}
std::string mistake_in_output(const std::string& line) {
  return mistake_in("[[output]]\n" + line + "\n");
}
std::string mistake_in_window(const std::string& line) {
  return mistake_in("[[output]]\n[[output.window]]\n" + line + "\n");
}

TEST(Outputs, AreNoneWhereTheFileSaysNothing) {
  EXPECT_TRUE(parse_outputs("", "wall.toml")->empty());
  EXPECT_TRUE(parse_outputs("[[sensor]]\ndriver = \"synthetic\"\n", "wall.toml")->empty());
}

TEST(Outputs, FillThePrimaryMonitorWhereNothingIsSaid) {
  const auto outputs = parse_outputs("[[output]]\n", "wall.toml");
  ASSERT_EQ(outputs->size(), 1U);
  EXPECT_EQ(outputs->front(), (Output{.windows = {Window{}}}));
}

TEST(Outputs, HoldEveryKey) {
  const auto outputs = parse_outputs(R"(
[[output]]
name = "foyer"
size = "3520x1080"
refreshes = 2
delay = 0.12
screen_lower_left = "-1 0.5 0"
screen_lower_right = "1, 0.5, 0"
screen_upper_left = "-1 1.5 0"
eye = "0 1.6 3"
[[output.window]]
monitor = "HDMI-1"
crop = "0 0 0.55 1"
rotation = 180
corners = "0.01 0.02  0.98 0  1 1  0 0.97"
blend_right = 0.1
gamma = 2.4
[[output.window]]
monitor = "1"
crop = "0.45 0 0.55 1"
blend_left = 0.1
)",
                                     "wall.toml");
  ASSERT_TRUE(outputs) << outputs.error().message;
  const Output expected{.name = "foyer",
                        .size = Size{3520, 1080},
                        .refreshes = 2,
                        .delay_s = 0.12,
                        .screen = Screen{.lower_left_m = {-1, 0.5, 0},
                                         .lower_right_m = {1, 0.5, 0},
                                         .upper_left_m = {-1, 1.5, 0},
                                         .eye_m = {0, 1.6, 3}},
                        .windows = {Window{.monitor = "HDMI-1",
                                           .crop = {0, 0, 0.55, 1},
                                           .rotation_deg = 180,
                                           .corners = {{{0.01, 0.02}, {0.98, 0}, {1, 1}, {0, 0.97}}},
                                           .blend = {.right = 0.1},
                                           .gamma = 2.4},
                                    Window{.monitor = "1", .crop = {0.45, 0, 0.55, 1}, .blend = {.left = 0.1}}}};
  EXPECT_EQ(outputs->front(), expected);
}

TEST(Outputs, SayWhereAMistakeIsAndWhatIsAllowed) {
  EXPECT_THAT(mistake_in("[[output]]\nsize = \"wide\"\n"),
              testing::StartsWith("wall.toml:2:8: output.size: is \"wide\""));
  EXPECT_THAT(mistake_in_window("crop = \"0.5 0 0.6 1\""),
              testing::StartsWith("wall.toml:3:8: output.window.crop: is"));
  EXPECT_THAT(mistake_in("[output]\nname = \"wall\"\n"), HasSubstr("write [[output]]"));
  EXPECT_THAT(mistake_in("[[output]]\n[output.window]\n"), HasSubstr("write [[output.window]]"));
  EXPECT_THAT(mistake_in("output = 3"), HasSubstr("write [[output]]"));
  EXPECT_THAT(mistake_in_output("monitr = \"HDMI-1\""), HasSubstr("monitr"));
  EXPECT_THAT(mistake_in("[[output]\n"), HasSubstr("TOML: "));
}

TEST(Outputs, SayEveryMistakeAtOnce) {
  const std::string said = mistake_in("[[output]]\nsize = \"1x1\"\n[[output.window]]\nrotation = 45\ngamma = 9\n");
  EXPECT_THAT(said, HasSubstr("output.size"));
  EXPECT_THAT(said, HasSubstr("output.window.rotation"));
  EXPECT_THAT(said, HasSubstr("output.window.gamma"));
}

TEST(Outputs, RefuseCropsOutsideOfThePicture) {
  for (const char* crop : {"", "0 0 1", "0 0 1 1 1", "0 0 0 1", "-0.1 0 1 1", "0 0.5 1 0.6", "0 0 nan 1", "a b c d"}) {
    EXPECT_THAT(mistake_in_window("crop = \"" + std::string(crop) + "\""), HasSubstr("output.window.crop")) << crop;
  }
  EXPECT_EQ(mistake_in_window("crop = \"0.666667 0 0.333333 1\""), "");
}

/// A picture that is mirrored, folded or of no size cannot be made straight.
TEST(Outputs, RefuseCornersThatCannotBeThoseOfAPicture) {
  EXPECT_THAT(mistake_in_window("corners = \"1 0  0 0  0 1  1 1\""), HasSubstr("convex"));  // mirrored
  EXPECT_THAT(mistake_in_window("corners = \"0 0  1 1  1 0  0 1\""), HasSubstr("convex"));  // crossed
  EXPECT_THAT(mistake_in_window("corners = \"0 0  1 0  0.1 0.1  0 1\""), HasSubstr("convex"));
  EXPECT_THAT(mistake_in_window("corners = \"0 0  0 0  1 1  0 1\""), HasSubstr("convex"));
  EXPECT_THAT(mistake_in_window("corners = \"0 0  9 0  1 1  0 1\""), HasSubstr("convex"));
  EXPECT_THAT(mistake_in_window("corners = \"0 0  1 0  1 1\""), HasSubstr("convex"));
}

TEST(Outputs, RefuseBlendsThatMeetWithinACrop) {
  EXPECT_THAT(mistake_in_window("crop = \"0 0 0.5 1\"\nblend_left = 0.3\nblend_right = 0.3"), HasSubstr("blend_right"));
  EXPECT_THAT(mistake_in_window("blend_top = 0.6\nblend_bottom = 0.6"), HasSubstr("blend_bottom"));
}

TEST(Outputs, RefuseTwoWindowsOnOneMonitorAndTwoOutputsOfOneName) {
  EXPECT_THAT(mistake_in("[[output]]\n[[output.window]]\n[[output.window]]\n"), HasSubstr("primary monitor"));
  EXPECT_THAT(mistake_in("[[output]]\n[[output.window]]\nmonitor = \"A\"\n[[output.window]]\nmonitor = \"A\"\n"),
              HasSubstr("\"A\" is used by another window"));
  EXPECT_THAT(mistake_in("[[output]]\n[[output]]\n"), HasSubstr("used twice"));
  EXPECT_THAT(mistake_in("[[output]]\nname = \"\"\n"), HasSubstr("1 to 64"));
}

TEST(Outputs, RefuseAScreenThatNobodyCanLookThrough) {
  const auto screen = [](const std::string& lower_left, const std::string& lower_right, const std::string& upper_left,
                         const std::string& eye) {
    return mistake_in_output("screen_lower_left = \"" + lower_left + "\"\nscreen_lower_right = \"" + lower_right +
                             "\"\nscreen_upper_left = \"" + upper_left + "\"\neye = \"" + eye + "\"");
  };
  EXPECT_EQ(screen("0 0 0", "2 0 0", "0 1 0", "1 1 3"), "");
  EXPECT_THAT(screen("0 0 0", "0 0 0", "0 1 0", "1 1 3"), HasSubstr("without area"));
  EXPECT_THAT(screen("0 0 0", "2 0 0", "1 1 0", "1 1 3"), HasSubstr("not form a rectangle"));
  EXPECT_THAT(screen("0 0 0", "2 0 0", "0 1 0", "1 1 -3"), HasSubstr("behind the screen"));
  EXPECT_THAT(screen("0 0", "2 0 0", "0 1 0", "1 1 3"), HasSubstr("X Y Z in meters"));
  EXPECT_THAT(mistake_in_output("eye = \"0 0 1\""), HasSubstr("is missing"));
}

TEST(Outputs, RefuseTooMany) {
  std::string many = "[[output]]\n";
  for (std::size_t i = 0; i <= kMaxWindows; ++i) many += "[[output.window]]\nmonitor = \"" + std::to_string(i) + "\"\n";
  EXPECT_THAT(mistake_in(many), HasSubstr("maximum 16"));
}

}  // namespace
}  // namespace yuragi::output
