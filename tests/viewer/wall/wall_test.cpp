// The real program on virtual monitors that come and go.

#include <cstdlib>
#include <fstream>
#include <memory>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <stb_image.h>

#include "tests/support/temporary_folder.hpp"
#include "tests/viewer/running_viewer.hpp"
#include "tests/viewer/started_program.hpp"
#include "tests/viewer/stream_server.hpp"
#include "tests/viewer/test_meadow.hpp"
#include "tests/viewer/wall/virtual_monitors.hpp"

namespace yuragi::viewer {
namespace {

constexpr int kWidth_px = 640;
constexpr int kHeight_px = 480;
constexpr std::uint32_t kWhite = 0xFFFFFF;

constexpr const char* kTwoHalves = R"(
[[output]]
[[output.window]]
monitor = "DUMMY0"
crop = "0 0 0.5 1"
[[output.window]]
monitor = "DUMMY1"
crop = "0.5 0 0.5 1"
)";

/// Where a pixel is in the rows of a picture.
std::size_t place(int width_px, int x, int y) {
  return static_cast<std::size_t>(y) * static_cast<std::size_t>(width_px) + static_cast<std::size_t>(x);
}

class WallTest : public testing::Test {
 protected:
  void SetUp() override {
    if (!monitors_.is_there()) GTEST_SKIP() << "Xorg does not run here: it wants to be root, or is not installed";
    ASSERT_TRUE(monitors_.arrange({"--addmode", "DUMMY1", "640x480"}));
    ASSERT_TRUE(monitors_.arrange({"--addmode", "DUMMY2", "800x600"}));
    ASSERT_TRUE(monitors_.arrange({"--output", "DUMMY0", "--mode", "640x480", "--pos", "0x0"}));
    ASSERT_TRUE(add_second());
  }

  bool add_second() const { return monitors_.arrange({"--output", "DUMMY1", "--mode", "640x480", "--pos", "640x0"}); }
  bool add_third() const { return monitors_.arrange({"--output", "DUMMY2", "--mode", "800x600", "--pos", "1280x0"}); }
  bool take_away(const std::string& monitor) const { return monitors_.arrange({"--output", monitor, "--off"}); }

  std::string configuration(const std::string& text) const {
    const std::filesystem::path file = folder_.path() / "wall.toml";
    std::ofstream(file) << text;
    return file.string();
  }
  std::unique_ptr<RunningViewer> start(std::vector<std::string> options) const {
    return std::make_unique<RunningViewer>(std::move(options), monitors_.environment(), folder_.path() / "said.txt");
  }

  /// The test card itself, of a file: no window is needed for it.
  std::vector<std::uint32_t> card(int width_px, int height_px) const {
    const std::filesystem::path file = folder_.path() / "card.png";
    RunningViewer drawing({"--test-card", "--size", std::to_string(width_px) + "x" + std::to_string(height_px),
                           "--screenshot", file.string()},
                          environment_without_screen(), folder_.path() / "card.txt");
    EXPECT_EQ(drawing.wait(), 0) << drawing.said();
    int width = 0;
    int height = 0;
    const std::unique_ptr<stbi_uc, void (*)(void*)> bytes(stbi_load(file.c_str(), &width, &height, nullptr, 3),
                                                          stbi_image_free);
    std::vector<std::uint32_t> pixels;
    for (int i = 0; bytes && i < 3 * width * height; i += 3) {
      pixels.push_back(
          static_cast<std::uint32_t>(bytes.get()[i] << 16U | bytes.get()[i + 1] << 8U | bytes.get()[i + 2]));
    }
    return pixels;
  }

  /// How many pixels of a monitor are another color than those of the picture from a place on. Not those of the border
  /// of two pixels, which a test card marks.
  int differences(const std::vector<std::uint32_t>& picture, int picture_width_px, int from_x, int monitor_x) const {
    const ScreenPixels seen = monitors_.pixels();
    int count = 0;
    for (int y = 2; y < kHeight_px - 2; ++y) {
      for (int x = 2; x < kWidth_px - 2; ++x) {
        const std::size_t at = place(picture_width_px, from_x + x, y);
        if (at >= picture.size() || monitor_x + x >= seen.width_px || seen.at(monitor_x + x, y) != picture[at]) ++count;
      }
    }
    return count;
  }

  /// Is all of a monitor of this color?
  bool is_all(std::uint32_t color, int monitor_x) const {
    const ScreenPixels seen = monitors_.pixels();
    if (seen.width_px < monitor_x + kWidth_px) return false;
    for (int y = 0; y < kHeight_px; ++y) {
      for (int x = 0; x < kWidth_px; ++x) {
        if (seen.at(monitor_x + x, y) != color) return false;
      }
    }
    return true;
  }

  const test::TemporaryFolder folder_;
  const VirtualMonitors monitors_{folder_.path()};
};

TEST_F(WallTest, OnePictureMeetsToThePixelOverTwoMonitors) {
  const std::vector<std::uint32_t> picture = card(2 * kWidth_px, kHeight_px);
  ASSERT_TRUE(is_all(kWhite, 0) && is_all(kWhite, kWidth_px)) << "the desktop is not to be seen at first";
  const auto viewer = start({"--config", configuration(kTwoHalves), "--test-card"});
  EXPECT_TRUE(comes_true([&] {
    return differences(picture, 2 * kWidth_px, 0, 0) == 0 &&
           differences(picture, 2 * kWidth_px, kWidth_px, kWidth_px) == 0;
  })) << viewer->said();
  EXPECT_EQ(viewer->end(), 0) << viewer->said();
}

TEST_F(WallTest, AMonitorThatLeavesAndReturnsIsFoundAgain) {
  const std::vector<std::uint32_t> picture = card(2 * kWidth_px, kHeight_px);
  const auto viewer = start({"--config", configuration(kTwoHalves), "--test-card"});
  const auto shows_left = [&] { return differences(picture, 2 * kWidth_px, 0, 0) == 0; };
  const auto shows_right = [&] { return differences(picture, 2 * kWidth_px, kWidth_px, kWidth_px) == 0; };
  ASSERT_TRUE(comes_true([&] { return shows_left() && shows_right(); })) << viewer->said();
  ASSERT_TRUE(take_away("DUMMY1"));
  EXPECT_TRUE(comes_true([&] { return viewer->said().find("DUMMY1 is gone") != std::string::npos; }));
  EXPECT_TRUE(comes_true(shows_left)) << "the other monitor is to go on";
  ASSERT_TRUE(add_second());
  EXPECT_TRUE(comes_true([&] { return shows_left() && shows_right(); })) << viewer->said();
  EXPECT_EQ(viewer->end(), 0);
}

TEST_F(WallTest, IsBlackBeforeADaemonAnswersAndShowsWhatItStreamsThenAsOtherPartsDo) {
  std::uint16_t port = 0;
  { port = StreamServer({}).port(); }
  const auto viewer = start({"--config", configuration(kTwoHalves), "--connect", "127.0.0.1:" + std::to_string(port)});
  const auto is_black = [&] { return is_all(0, 0) && is_all(0, kWidth_px); };
  ASSERT_TRUE(comes_true(is_black)) << viewer->said();

  const pose::Skeleton meadow = test_meadow(30, 6.0);
  wire::FrameEncoder encoder;
  StreamServer server(
      greeting_for(meadow) + frame_of(meadow, test_pose(meadow, 0.0, 0.3, 0.0, 140.0), 1, 0.1, 140.0, encoder), port);
  const auto is_lit = [&](int monitor_x) {
    const ScreenPixels seen = monitors_.pixels();
    // Sky above, light.
    return (seen.at(monitor_x + kWidth_px / 2, 20) & 0xFFU) > 100;
  };
  EXPECT_TRUE(comes_true([&] { return is_lit(0) && is_lit(kWidth_px); })) << viewer->said();

  // Another part of the wall gives up all that it can, and so does this one.
  server.send(wire::encode(wire::Sensors{.sensors = {}, .wind = {}, .given_up = 6}));
  EXPECT_TRUE(comes_true([&] { return viewer->said().find("50 % as wide and high") != std::string::npos; }))
      << viewer->said();
  EXPECT_EQ(viewer->end(), 0) << viewer->said();
}

TEST_F(WallTest, AMonitorThatDoesNotExistIsAnErrorWithThoseThatDo) {
  const auto viewer = start({"--config", configuration("[[output]]\n[[output.window]]\nmonitor = \"HDMI-7\"\n")});
  EXPECT_EQ(viewer->wait(), 69);
  EXPECT_THAT(viewer->said(),
              testing::AllOf(testing::HasSubstr("no monitor \"HDMI-7\""), testing::HasSubstr("0  DUMMY0  640 x 480"),
                             testing::HasSubstr("1  DUMMY1  640 x 480")));
}

TEST_F(WallTest, ThreeMonitorsOfDifferentSizesAndTurned) {
  ASSERT_TRUE(add_third());
  const auto viewer = start({"--config", configuration(R"(
[[output]]
name = "other"
[[output]]
name = "three"
size = "1280x480"
[[output.window]]
monitor = "0"
crop = "0 0 0.5 1"
rotation = 180
[[output.window]]
monitor = "DUMMY1"
crop = "0.5 0 0.5 1"
[[output.window]]
monitor = "DUMMY2"
)"),
                             "--output", "three", "--test-card"});
  std::vector<std::uint32_t> picture = card(2 * kWidth_px, kHeight_px);
  std::vector<std::uint32_t> turned;
  for (int y = kHeight_px - 1; y >= 0; --y) {
    for (int x = kWidth_px - 1; x >= 0; --x) turned.push_back(picture[place(2 * kWidth_px, x, y)]);
  }
  EXPECT_TRUE(comes_true([&] {
    return differences(turned, kWidth_px, 0, 0) == 0 && differences(picture, 2 * kWidth_px, kWidth_px, kWidth_px) == 0;
  })) << viewer->said();
  // The third shows all of the picture, drawn out: its corner is marked, and so is its middle.
  EXPECT_TRUE(comes_true([&] {
    const ScreenPixels seen = monitors_.pixels();
    return seen.width_px == 2080 && (seen.at(1280, 0) >> 16U) > 200 && (seen.at(1280 + 400, 300) & 0xFFU) > 150;
  })) << viewer->said();
  EXPECT_EQ(viewer->end(), 0);
}

/// Nothing of this needs a monitor.
TEST(WallOptions, MistakesInTheConfigurationEndItBeforeAnyWindow) {
  const test::TemporaryFolder folder;
  const auto ended = [&folder](const std::string& text, std::vector<std::string> options) {
    const std::filesystem::path file = folder.path() / "wall.toml";
    std::ofstream(file) << text;
    options.insert(options.begin(), {"--config", file.string()});
    RunningViewer viewer(options, environment_without_screen(), folder.path() / "said.txt");
    const int code = viewer.wait();
    return std::pair(code, viewer.said());
  };
  EXPECT_THAT(ended("[[output]]\nrefreshes = 9\n", {}),
              testing::Pair(78, testing::HasSubstr("wall.toml:2:13: output.refreshes")));
  EXPECT_THAT(ended("[[output]]\nname = \"a\"\n", {"--output", "b"}),
              testing::Pair(64, testing::HasSubstr("no [[output]] of the name 'b'; it has a")));
  RunningViewer viewer({"--config", "/nonexistent/wall.toml"}, environment_without_screen(),
                       folder.path() / "said.txt");
  EXPECT_EQ(viewer.wait(), 66);
}

}  // namespace
}  // namespace yuragi::viewer
