// The real program in a window on a virtual X server, with keys and a mouse that are pressed as a person does.

#include <algorithm>
#include <cstdlib>
#include <memory>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/temporary_folder.hpp"
#include "tests/viewer/old_opengl.hpp"
#include "tests/viewer/running_viewer.hpp"
#include "tests/viewer/stream_server.hpp"
#include "tests/viewer/test_meadow.hpp"
#include "tests/viewer/x_server.hpp"

namespace yuragi::viewer {
namespace {

constexpr int kScreenWidth_px = 640;
constexpr int kScreenHeight_px = 480;
// The window has no frame, and stands in the upper left corner.
constexpr int kWidth_px = 480;
constexpr int kHeight_px = 360;
constexpr std::uint32_t kWhite = 0xFFFFFF;

/// A part of the screen.
struct Part {
  int x = 0;
  int y = 0;
  int width_px = 0;
  int height_px = 0;
};
constexpr Part kWindow{.width_px = kWidth_px, .height_px = kHeight_px};
constexpr Part kDesktop{
    .x = kWidth_px, .width_px = kScreenWidth_px - kWidth_px, .height_px = kScreenHeight_px};  // beside the window
constexpr Part kTop{.width_px = kWidth_px, .height_px = kHeight_px / 5};
constexpr Part kBottom{.y = kHeight_px * 3 / 5, .width_px = kWidth_px, .height_px = kHeight_px / 5};
constexpr Part kUpperLeft{.x = 10, .y = 10, .width_px = 60, .height_px = 60};
constexpr Part kLowerLeft{.x = 10, .y = kHeight_px - 70, .width_px = 60, .height_px = 60};
constexpr Part kLowerRight{.x = kWidth_px - 70, .y = kHeight_px - 70, .width_px = 60, .height_px = 60};
constexpr Part kMiddle{.x = kWidth_px / 2 - 30, .y = kHeight_px / 2 - 30, .width_px = 60, .height_px = 60};
constexpr Part kWords{.x = kWidth_px / 2 - 150, .y = kHeight_px / 2 - 20, .width_px = 300, .height_px = 40};

int channel(std::uint32_t color, unsigned shift) {
  return static_cast<int>(color >> shift & 0xFFU);
}

/// The mean of a color of a part, 0 to 255.
double mean(const ScreenPixels& screen, const Part& part, unsigned shift) {
  double sum = 0.0;
  for (int y = part.y; y < part.y + part.height_px; ++y) {
    for (int x = part.x; x < part.x + part.width_px; ++x) sum += channel(screen.at(x, y), shift);
  }
  return sum / part.width_px / part.height_px;
}
double red(const ScreenPixels& screen, const Part& part) {
  return mean(screen, part, 16);
}
double green(const ScreenPixels& screen, const Part& part) {
  return mean(screen, part, 8);
}
double blue(const ScreenPixels& screen, const Part& part) {
  return mean(screen, part, 0);
}

/// The mean difference of the colors of a part, 0 to 255.
double difference(const ScreenPixels& a, const ScreenPixels& b, const Part& part) {
  double sum = 0.0;
  for (int y = part.y; y < part.y + part.height_px; ++y) {
    for (int x = part.x; x < part.x + part.width_px; ++x) {
      for (const unsigned shift : {16U, 8U, 0U}) {
        sum += std::abs(channel(a.at(x, y), shift) - channel(b.at(x, y), shift));
      }
    }
  }
  return sum / 3.0 / part.width_px / part.height_px;
}

class WindowTest : public testing::Test {
 protected:
  void SetUp() override {
    ASSERT_TRUE(screen_.is_there()) << "Xvfb does not start";
    screen_.point(kWidth_px / 2, kHeight_px / 3);
  }

  /// Starts a viewer without texts. Its picture may not be there yet.
  std::unique_ptr<RunningViewer> begin(const StreamServer& server, const std::string& quality,
                                       const std::vector<std::string>& more_environment = {}) const {
    std::vector<std::string> environment = screen_.environment();
    environment.insert(environment.end(), more_environment.begin(), more_environment.end());
    return std::make_unique<RunningViewer>(
        std::vector<std::string>{"--connect", "127.0.0.1:" + std::to_string(server.port()), "--size",
                                 std::to_string(kWidth_px) + "x" + std::to_string(kHeight_px), "--no-overlay", "--look",
                                 "quality=" + quality, "--look", "clouds=0", "--scale", "0.5"},
        environment, folder_.path() / "said.txt");
  }

  /// A viewer without texts, once the stream's meadow is seen. In quality low it draws less of it while the machine is
  /// busy.
  std::unique_ptr<RunningViewer> start(const StreamServer& server, const std::string& quality = "low") const {
    auto viewer = begin(server, quality);
    EXPECT_TRUE(comes_true([this] { return shows_grass(); })) << viewer->said();
    return viewer;
  }

  /// The grass is green: not before the stream has come.
  bool shows_grass() const {
    const ScreenPixels seen = screen_.pixels();
    return green(seen, kBottom) > 40.0 && green(seen, kBottom) > 2.0 * blue(seen, kBottom);
  }

  /// What is seen when nothing changes any more.
  ScreenPixels settled() const {
    constexpr int kStill = 50;  // a second, so that a machine that is busy has drawn meanwhile
    constexpr double kMinChange = 0.5;
    ScreenPixels before = screen_.pixels();
    int still = 0;
    EXPECT_TRUE(comes_true([&] {
      ScreenPixels now = screen_.pixels();
      still = difference(now, before, kWindow) < kMinChange ? still + 1 : 0;
      before = std::move(now);
      return still == kStill;
    }));
    return before;
  }

  wire::Bytes frame(double lean_rad, double time_s) {
    return frame_of(meadow_, test_pose(meadow_, 0.0, lean_rad, 0.0, 140.0), ++sequence_, time_s, 140.0, encoder_);
  }

  const test::TemporaryFolder folder_;
  const XServer screen_{
      {"Xvfb", "-screen", "0", std::to_string(kScreenWidth_px) + "x" + std::to_string(kScreenHeight_px) + "x24"}};
  const pose::Skeleton meadow_ = test_meadow(30, 6.0);
  wire::FrameEncoder encoder_;
  std::uint64_t sequence_ = 0;
};

TEST_F(WindowTest, ShowsThePictureAndEndsWhenAsked) {
  const StreamServer server(greeting_for(meadow_) + frame(0.3, 0.1));
  const auto viewer = start(server);
  EXPECT_EQ(viewer->end(), 0) << viewer->said();
}

TEST_F(WindowTest, ShowsThePictureByOpenGl31) {
  const StreamServer server(greeting_for(meadow_) + frame(0.3, 0.1));
  const auto viewer = begin(server, "low", opengl_31());
  EXPECT_TRUE(comes_true([this] { return shows_grass(); })) << viewer->said();
  for (const char* panel : {"F1", "F2", "F3", "F4"}) ASSERT_TRUE(screen_.type(panel));  // letters are programs, too
  const ScreenPixels plain = screen_.pixels();
  EXPECT_TRUE(comes_true([&] { return difference(screen_.pixels(), plain, kWindow) > 1.0; })) << viewer->said();
  EXPECT_EQ(viewer->end(), 0) << viewer->said();
}

TEST_F(WindowTest, EndsWith69AndNamesTheDriverThatIsTooOld) {
  const StreamServer server{wire::Bytes()};
  const auto viewer = begin(server, "low", opengl_21());
  EXPECT_EQ(viewer->wait(), 69);
  EXPECT_THAT(viewer->said(), testing::ContainsRegex("graphics driver \"llvmpipe.*\\(2\\.1.*\\) lacks OpenGL 3\\.1"));
}

TEST_F(WindowTest, WordsStandInItUntilAPictureComes) {
  StreamServer server{wire::Bytes()};
  const auto viewer = begin(server, "low");
  const auto shows_words = [this] {
    const ScreenPixels seen = screen_.pixels();
    int letters = 0;  // light ones, on a dark ground: grass has little blue, too
    for (int y = kWords.y; y < kWords.y + kWords.height_px; ++y) {
      for (int x = kWords.x; x < kWords.x + kWords.width_px; ++x) letters += channel(seen.at(x, y), 0) > 110 ? 1 : 0;
    }
    return letters > 200 && blue(seen, kWords) < 60.0;
  };
  ASSERT_TRUE(comes_true(shows_words)) << viewer->said();
  // The viewer gives up a daemon that is silent, and connects again: what is sent between is lost.
  EXPECT_TRUE(comes_true([&, next = 1]() mutable {
    server.send(greeting_for(meadow_) + frame(0.3, 0.1 * next++));
    return shows_grass() && !shows_words();
  })) << viewer->said();
  EXPECT_EQ(viewer->end(), 0) << viewer->said();
}

TEST_F(WindowTest, EscapeEndsIt) {
  const StreamServer server(greeting_for(meadow_) + frame(0.3, 0.1));
  const auto viewer = start(server);
  ASSERT_TRUE(screen_.type("Escape"));
  EXPECT_EQ(viewer->wait(), 0) << viewer->said();
}

TEST_F(WindowTest, F1ToF4ShowAndHideEachItsTextsInItsPlace) {
  const StreamServer server(greeting_for(meadow_) + wire::encode(wire::Sensors{}) + frame(0.3, 0.1));
  const auto viewer = start(server, "medium");
  struct Texts {
    const char* key;
    Part place;
    Part elsewhere;
  };
  // A text grows with what there is to report (a lost stream, the age of a reading), at most to the next corner.
  const ScreenPixels plain = settled();
  const auto changes = [&](const Part& part) { return difference(screen_.pixels(), plain, part); };
  for (const Texts& texts : {Texts{"F1", kMiddle, kUpperLeft}, Texts{"F2", kUpperLeft, kLowerRight},
                             Texts{"F3", kLowerLeft, kUpperLeft}, Texts{"F4", kLowerRight, kUpperLeft}}) {
    SCOPED_TRACE(texts.key);
    ASSERT_TRUE(screen_.type(texts.key));
    EXPECT_TRUE(comes_true([&] { return changes(texts.place) > 8.0; }));
    EXPECT_LT(changes(texts.elsewhere), 3.0);
    ASSERT_TRUE(screen_.type(texts.key));
    EXPECT_TRUE(comes_true([&] { return changes(texts.place) < 3.0; }));
  }
  EXPECT_EQ(viewer->end(), 0) << viewer->said();
}

TEST_F(WindowTest, F5FillsTheScreenAndGivesItBack) {
  const StreamServer server(greeting_for(meadow_) + frame(0.3, 0.1));
  const auto viewer = start(server);
  const auto uncovered = [this] {
    const ScreenPixels seen = screen_.pixels();
    int count = 0;
    for (int y = 0; y < kScreenHeight_px; ++y) {
      for (int x = kDesktop.x; x < kScreenWidth_px; ++x) count += seen.at(x, y) == kWhite ? 1 : 0;
    }
    return count;
  };
  constexpr int kAll = kDesktop.width_px * kDesktop.height_px;
  ASSERT_EQ(uncovered(), kAll);
  ASSERT_TRUE(screen_.type("F5"));
  EXPECT_TRUE(comes_true([&] { return uncovered() == 0 && green(screen_.pixels(), kDesktop) > 40.0; }));
  ASSERT_TRUE(screen_.type("F5"));
  EXPECT_TRUE(comes_true([&] { return uncovered() == kAll; }));
  EXPECT_TRUE(comes_true([&] { return shows_grass(); }));
  EXPECT_EQ(viewer->end(), 0) << viewer->said();
}

TEST_F(WindowTest, SpaceStopsThePictureAndGoesOnWithWhatIsLive) {
  StreamServer server(greeting_for(meadow_) + frame(0.0, 0.1));
  const auto viewer = start(server, "medium");
  const ScreenPixels upright = settled();
  const auto moved = [&] { return difference(screen_.pixels(), upright, kBottom); };
  constexpr Part kNotice{.x = kWidth_px / 2 - 40, .y = kHeight_px - 20, .width_px = 80, .height_px = 12};
  ASSERT_TRUE(screen_.type("space"));
  ASSERT_TRUE(comes_true([&] { return difference(screen_.pixels(), upright, kNotice) > 8.0; }))
      << "it says that it is paused";
  for (int i = 1; i <= 5; ++i) server.send(frame(1.1, 0.1 + 0.1 * i));
  // Other things are still drawn while the grass stands: the help comes and goes.
  for (const bool is_shown : {true, false}) {
    ASSERT_TRUE(screen_.type("F1"));
    EXPECT_TRUE(comes_true([&] { return (difference(screen_.pixels(), upright, kMiddle) > 8.0) == is_shown; }));
  }
  EXPECT_LT(moved(), 3.0);
  ASSERT_TRUE(screen_.type("space"));
  // On a busy machine the viewer may have taken the server for dead meanwhile, and connected again: what is live is
  // sent on.
  EXPECT_TRUE(comes_true([&, next = 6]() mutable {
    server.send(frame(1.1, 0.1 + 0.1 * next++));
    return moved() > 6.0;
  }));
  EXPECT_EQ(viewer->end(), 0) << viewer->said();
}

TEST_F(WindowTest, DigitsShowTheDaemonsCameras) {
  wire::Sensors status;
  status.cameras = {look::Camera{.name = "far", .pitch_deg = 4.0, .distance_m = 6.0, .fov_deg = 60.0},
                    look::Camera{.name = "above", .pitch_deg = 50.0, .distance_m = 3.0, .fov_deg = 20.0}};
  const StreamServer server(greeting_for(meadow_) + wire::encode(status) + frame(0.3, 0.1));
  const auto viewer = start(server);
  // From above no sky is seen, which is bluer than grass.
  const auto shows_sky = [this] {
    const ScreenPixels seen = screen_.pixels();
    return blue(seen, kTop) > 0.7 * red(seen, kTop);
  };
  ASSERT_TRUE(comes_true(shows_sky));
  ASSERT_TRUE(screen_.type("2"));
  EXPECT_TRUE(comes_true([&] { return !shows_sky(); }));
  ASSERT_TRUE(screen_.type("1"));
  EXPECT_TRUE(comes_true(shows_sky));
  EXPECT_EQ(viewer->end(), 0) << viewer->said();
}

}  // namespace
}  // namespace yuragi::viewer
