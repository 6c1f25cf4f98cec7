// The real program: pictures in files, drawn without a display. They are looked at as a person
// would: sky above, grass below, and the grass leans.

#include <algorithm>
#include <array>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <memory>
#include <sstream>
#include <thread>

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <stb_image.h>
#include <sys/wait.h>
#include <unistd.h>

#include "tests/support/places.hpp"
#include "tests/viewer/old_opengl.hpp"
#include "tests/viewer/started_program.hpp"
#include "tests/viewer/test_meadow.hpp"
#include "tests/viewer/test_models.hpp"

namespace yuragi::viewer {
namespace {

constexpr int kWidth_px = 480;
constexpr int kHeight_px = 270;

struct Rgb {
  double r = 0.0;
  double g = 0.0;
  double b = 0.0;
  double brightness() const { return (r + g + b) / 3.0; }
};

class Picture {
 public:
  explicit Picture(const std::filesystem::path& file)
      : pixels_(stbi_load(file.c_str(), &width_, &height_, nullptr, 3), stbi_image_free) {}

  bool is_there() const { return pixels_ != nullptr; }
  int width() const { return width_; }
  int height() const { return height_; }

  Rgb mean(double from_top, double to_bottom) const {
    Rgb sum;
    const int first = static_cast<int>(from_top * height_);
    const int last = static_cast<int>(to_bottom * height_);
    for (int y = first; y < last; ++y) {
      for (int x = 0; x < width_; ++x) {
        const auto* at = pixels_.get() + std::ptrdiff_t{3} * (y * width_ + x);
        sum.r += at[0];
        sum.g += at[1];
        sum.b += at[2];
      }
    }
    const double count = static_cast<double>(last - first) * width_;
    return {sum.r / count, sum.g / count, sum.b / count};
  }

  /// The brightness of the darkest pixel.
  double darkest(double from_top, double to_bottom) const {
    double least = 255.0;
    for (int i = 3 * width_ * static_cast<int>(from_top * height_);
         i < 3 * width_ * static_cast<int>(to_bottom * height_); i += 3) {
      least = std::min(least, (pixels_.get()[i] + pixels_.get()[i + 1] + pixels_.get()[i + 2]) / 3.0);
    }
    return least;
  }

  /// Mean absolute difference of two pictures' pixels, 0 to 255.
  double difference(const Picture& other) const {
    double sum = 0.0;
    const int count = 3 * width_ * height_;
    for (int i = 0; i < count; ++i) sum += std::abs(pixels_.get()[i] - other.pixels_.get()[i]);
    return sum / count;
  }

  /// How many times as much the brightness changes from row to row as from column to column: upright blades make it
  /// small.
  double slant(double from_top, double to_bottom) const {
    double across = 0.0;
    double down = 0.0;
    for (int y = static_cast<int>(from_top * height_); y < static_cast<int>(to_bottom * height_) - 1; ++y) {
      for (int x = 0; x + 1 < width_; ++x) {
        across += std::abs(green(x + 1, y) - green(x, y));
        down += std::abs(green(x, y + 1) - green(x, y));
      }
    }
    return down / across;
  }

 private:
  int green(int x, int y) const { return pixels_.get()[3 * (y * width_ + x) + 1]; }

  int width_ = 0;
  int height_ = 0;
  std::unique_ptr<stbi_uc, void (*)(void*)> pixels_;
};

struct Ended {
  int code = -1;
  std::string said;  // on standard error
};

/// Runs a program to its end.
Ended run(std::vector<std::string> words, const std::filesystem::path& folder, std::vector<std::string> environment) {
  const std::filesystem::path said = folder / "said";
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, said.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
  const pid_t child = start_program(std::move(words), std::move(environment), &actions);
  posix_spawn_file_actions_destroy(&actions);
  if (child == 0) return {};
  int status = 0;
  waitpid(child, &status, 0);
  std::ostringstream text;
  text << std::ifstream(said).rdbuf();
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, text.str()};
}

/// Streams one pose of a meadow to whoever comes, while the viewer takes a picture of it.
class PictureTest : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::temp_directory_path() / ("yuragi-picture-" + std::to_string(::getpid()));
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  /// Runs the viewer where there is no display.
  Ended take_picture(std::uint16_t port, const std::string& file, const std::vector<std::string>& more,
                     const std::vector<std::string>& more_environment = {}) const {
    std::vector<std::string> words = {test::built_path("bin/yuragi-viewer"),
                                      "--connect",
                                      "127.0.0.1:" + std::to_string(port),
                                      "--size",
                                      std::to_string(kWidth_px) + "x" + std::to_string(kHeight_px),
                                      "--screenshot",
                                      (folder_ / file).string(),
                                      "--look",
                                      "clouds=0"};  // their shadows go as far as the program happens to have run
    words.insert(words.end(), more.begin(), more.end());
    std::vector<std::string> environment = environment_without_screen();
    environment.insert(environment.end(), more_environment.begin(), more_environment.end());
    return run(words, folder_, environment);
  }

  Ended run_without_screen(const std::vector<std::string>& arguments) const {
    std::vector<std::string> words = {test::built_path("bin/yuragi-viewer")};
    words.insert(words.end(), arguments.begin(), arguments.end());
    return run(words, folder_, environment_without_screen());
  }

  std::unique_ptr<Picture> take(const std::string& file, double lean_rad, const std::vector<std::string>& more,
                                const wire::Sensors& status = {},
                                const std::vector<std::string>& more_environment = {}) const {
    // From the greeting on the meadow stands still: the picture is of this pose, whenever it is taken.
    const pose::Skeleton meadow = test_meadow(60, 6.0);
    wire::FrameEncoder encoder;
    wire::Bytes greeting = greeting_for(meadow) + wire::encode(status);
    for (std::uint64_t i = 0; i < 3; ++i) {
      greeting = greeting + frame_of(meadow, test_pose(meadow, 0.0, lean_rad, 0.0, 140.0), i,
                                     0.1 * static_cast<double>(i), 140.0, encoder);
    }
    const StreamServer server(greeting);
    const Ended ended = take_picture(server.port(), file, more, more_environment);
    EXPECT_EQ(ended.code, 0) << ended.said;
    EXPECT_THAT(ended.said, testing::Not(testing::HasSubstr("OpenGL")));
    return std::make_unique<Picture>(folder_ / file);
  }

  std::filesystem::path folder_;
};

TEST_F(PictureTest, ShowsSkyAboveAndGreenBelow) {
  const auto picture = take("upright.png", 0.0, {"--frames", "3"});
  ASSERT_TRUE(picture->is_there());
  EXPECT_EQ(picture->width(), kWidth_px);
  EXPECT_EQ(picture->height(), kHeight_px);

  // Evening light is warm on both; the grass has hardly any blue, and shade between its blades.
  const Rgb sky = picture->mean(0.0, 0.2);
  EXPECT_GT(sky.brightness(), 100.0);
  EXPECT_GT(sky.b, 0.8 * sky.g);
  const Rgb grass = picture->mean(0.6, 1.0);
  EXPECT_GT(grass.g, 40.0);
  EXPECT_GT(grass.g, 0.9 * grass.r);
  EXPECT_GT(grass.g, 2.0 * grass.b);
  EXPECT_LT(grass.brightness(), 0.8 * sky.brightness());
}

TEST_F(PictureTest, ShowsThatTheGrassLeans) {
  const auto upright = take("upright.png", 0.0, {"--frames", "2"});
  const auto again = take("again.png", 0.0, {"--frames", "4"});
  const auto leaning = take("leaning.png", 1.1, {"--frames", "2"});
  ASSERT_TRUE(upright->is_there() && again->is_there() && leaning->is_there());
  EXPECT_LT(upright->difference(*again), 0.1);
  EXPECT_GT(upright->difference(*leaning), 10.0);
  EXPECT_GT(leaning->slant(0.6, 1.0), 1.2 * upright->slant(0.6, 1.0));
}

TEST_F(PictureTest, DrawsTheOverlayWhenAsked) {
  const auto without = take("without.png", 0.3, {"--frames", "2"});
  const auto with = take("with.png", 0.3, {"--frames", "2", "--overlay", "--samples", "1", "--camera", "225,7,4"});
  ASSERT_TRUE(without->is_there() && with->is_there());
  EXPECT_GT(without->difference(*with), 1.0);
}

TEST_F(PictureTest, IsTheSameByOpenGl31AndHasTheOverlay) {
  const auto newest = take("newest.png", 0.3, {"--frames", "2", "--samples", "1"});
  const auto older = take("older.png", 0.3, {"--frames", "2", "--samples", "1"}, {}, opengl_31());
  const auto with = take("with.png", 0.3, {"--frames", "2", "--samples", "1", "--overlay"}, {}, opengl_31());
  ASSERT_TRUE(newest->is_there() && older->is_there() && with->is_there());
  EXPECT_LT(newest->difference(*older), 0.1);
  EXPECT_GT(older->difference(*with), 1.0);
}

TEST_F(PictureTest, EndsWith69AndNamesTheDriverThatIsTooOld) {
  const Ended ended = take_picture(1, "none.png", {}, opengl_21());
  EXPECT_EQ(ended.code, 69);
  EXPECT_THAT(ended.said, testing::ContainsRegex("graphics driver \"llvmpipe.*\\(2\\.1.*\\) lacks OpenGL 3\\.1"));
}

TEST_F(PictureTest, ShowsHelpProfilerAndWindAndTheirScale) {
  const auto without = take("without.png", 0.3, {"--frames", "2", "--samples", "1"});
  for (const std::string panel : {"help", "profiler", "wind"}) {
    const auto with = take(panel + ".png", 0.3, {"--frames", "2", "--samples", "1", "--show", panel});
    ASSERT_TRUE(without->is_there() && with->is_there());
    EXPECT_GT(without->difference(*with), 1.0) << panel;
  }
  const auto small = take("small.png", 0.3, {"--frames", "2", "--samples", "1", "--show", "help", "--scale", "0.5"});
  ASSERT_TRUE(small->is_there());
  EXPECT_GT(small->difference(Picture(folder_ / "help.png")), 1.0);
}

TEST_F(PictureTest, IsSeenByTheDaemonsCameraOfTheHourOrTheOneThatIsAskedFor) {
  wire::Sensors status;
  status.cameras = {look::Camera{.name = "day", .pitch_deg = 4.0, .distance_m = 6.0, .fov_deg = 60.0},
                    look::Camera{.name = "night", .pitch_deg = 50.0, .distance_m = 3.0, .fov_deg = 20.0}};
  status.camera = 1;
  const auto hours = take("hours.png", 0.3, {"--frames", "2"}, status);
  const auto night = take("night.png", 0.3, {"--frames", "2", "--camera", "night"}, status);
  const auto day = take("day.png", 0.3, {"--frames", "2", "--camera", "day"}, status);
  const auto by_hand = take("by hand.png", 0.3, {"--frames", "2", "--camera", "20,30,4"}, status);
  ASSERT_TRUE(hours->is_there() && night->is_there() && day->is_there() && by_hand->is_there());
  EXPECT_LT(hours->difference(*night), 0.1);
  EXPECT_GT(hours->difference(*day), 10.0);
  EXPECT_GT(hours->difference(*by_hand), 10.0);
  EXPECT_GT(day->mean(0.0, 0.2).b, 2.0 * night->mean(0.0, 0.2).b) << "sky, and grass";
}

TEST_F(PictureTest, EndsWith64ForACameraThatTheDaemonDoesNotHave) {
  const pose::Skeleton meadow = test_meadow(4, 1.0);
  wire::FrameEncoder encoder;
  wire::Sensors status;
  const auto refusal_of = [&](const wire::Sensors& said) {
    const StreamServer server(greeting_for(meadow) + wire::encode(said) +
                              frame_of(meadow, test_pose(meadow, 0.0, 0.0, 0.0, 0.0), 1, 0.1, 0.0, encoder));
    const Ended ended = take_picture(server.port(), "none.png", {"--camera", "dawn"});
    EXPECT_EQ(ended.code, 64);
    return ended.said;
  };
  EXPECT_THAT(refusal_of(status), testing::HasSubstr("has no camera 'dawn'; it has none: there is no [[camera]]"));
  status.cameras = {look::Camera{.name = "day"}, look::Camera{.name = "night"}};
  EXPECT_THAT(refusal_of(status), testing::HasSubstr("has no camera 'dawn'; it has day, night"));
}

TEST_F(PictureTest, FadesToBlackOutsideOfOpeningHoursWhenAsked) {
  wire::Sensors closing;
  closing.shaping.openness = 0.5;
  wire::Sensors closed;
  closed.shaping.openness = 0.0;
  const std::vector<std::string> dark = {"--frames", "2", "--dark-when-closed"};
  const auto open = take("open.png", 0.3, dark);
  const auto half = take("half.png", 0.3, dark, closing);
  const auto black = take("black.png", 0.3, dark, closed);
  const auto unasked = take("unasked.png", 0.3, {"--frames", "2"}, closed);
  ASSERT_TRUE(open->is_there() && half->is_there() && black->is_there() && unasked->is_there());
  EXPECT_GT(open->mean(0.0, 1.0).brightness(), 60.0);
  EXPECT_NEAR(half->mean(0.0, 1.0).brightness(), 0.5 * open->mean(0.0, 1.0).brightness(), 2.0);
  EXPECT_EQ(black->mean(0.0, 1.0).brightness(), 0.0);
  EXPECT_LT(unasked->difference(*open), 0.1);
}

TEST_F(PictureTest, ShowsEveryKindThatTheStreamCarriesAndEachAlone) {
  const std::vector<wire::SceneModel> garden = test_garden();
  std::vector<float> opacities(garden.size(), 1.0F);
  opacities.front() = 0.0F;
  wire::FrameEncoder encoder;
  wire::Bytes greeting = greeting_for(garden);
  for (std::uint64_t i = 0; i < 3; ++i) {
    greeting = greeting + frame_of(garden, opacities, 0.1 * static_cast<double>(i), 0.5, i, encoder);
  }
  const StreamServer server(greeting);
  EXPECT_EQ(take_picture(server.port(), "all.png", {"--frames", "2"}).code, 0);
  EXPECT_EQ(take_picture(server.port(), "hidden.png", {"--frames", "2", "--scene", "grass"}).code, 0);
  EXPECT_EQ(take_picture(server.port(), "tree.png", {"--frames", "2", "--scene", "tree"}).code, 0);
  const Picture all(folder_ / "all.png");
  const Picture hidden(folder_ / "hidden.png");
  const Picture tree(folder_ / "tree.png");
  ASSERT_TRUE(all.is_there() && hidden.is_there() && tree.is_there());
  EXPECT_GT(all.difference(tree), 3.0);

  // A tree's crown hides what would be bright sky; where the meadow is hidden, nothing does.
  EXPECT_LT(tree.darkest(0.15, 0.35), 60.0);
  EXPECT_GT(hidden.darkest(0.0, 0.15), 60.0);

  const Ended ended = take_picture(server.port(), "none.png", {"--scene", "a scene that is not there"});
  EXPECT_EQ(ended.code, 64);
  EXPECT_THAT(ended.said, testing::HasSubstr("it has: grass, fur, curtain"));
}

/// The scenes change while it watches: a tree in place of a garden.
TEST_F(PictureTest, ShowsTheNewScenesWhenTheyHaveChanged) {
  const std::vector<wire::SceneModel> garden = test_garden();
  const std::vector<wire::SceneModel> tree = {test_model("tree")};
  const std::vector<float> all_opaque(garden.size(), 1.0F);
  wire::FrameEncoder encoder;
  const auto frames_of = [&](const std::vector<wire::SceneModel>& models, int first) {
    wire::Bytes bytes;
    for (int i = first; i < first + 3; ++i) {
      bytes = bytes + frame_of(models, std::span(all_opaque).first(models.size()), 0.1 * i, 0.5,
                               static_cast<std::uint64_t>(i), encoder);
    }
    return bytes;
  };
  const StreamServer changing(greeting_for(garden) + frames_of(garden, 0) + wire::encode(wire::Scenes{tree}) +
                              frames_of(tree, 3));
  const StreamServer steady(greeting_for(tree) + frames_of(tree, 3));
  const std::vector<std::string> late = {"--at", "1.5", "--camera", "20,10,12"};
  const Ended ended = take_picture(changing.port(), "changed.png", late);
  EXPECT_EQ(ended.code, 0) << ended.said;
  const Ended at_once = take_picture(steady.port(), "steady.png", late);
  EXPECT_EQ(at_once.code, 0) << at_once.said;
  const StreamServer before(greeting_for(garden) + frames_of(garden, 0));
  EXPECT_EQ(take_picture(before.port(), "before.png", late).code, 0);
  const Picture changed(folder_ / "changed.png");
  const Picture expected(folder_ / "steady.png");
  const Picture old(folder_ / "before.png");
  ASSERT_TRUE(changed.is_there() && expected.is_there() && old.is_there());
  EXPECT_LT(changed.difference(expected), 0.2 * changed.difference(old)) << changed.difference(old);
}

TEST_F(PictureTest, EndsWith69WhenNoDaemonAnswers) {
  std::uint16_t port = 0;
  { port = StreamServer({}).port(); }
  const Ended ended = take_picture(port, "none.png", {"--wait", "0.3"});
  EXPECT_EQ(ended.code, 69);
  EXPECT_THAT(ended.said, testing::HasSubstr("yuragi run"));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "none.png"));
}

TEST_F(PictureTest, EndsWith73WhenThePictureCannotBeWritten) {
  const pose::Skeleton meadow = test_meadow(4, 1.0);
  wire::FrameEncoder encoder;
  const StreamServer server(greeting_for(meadow) +
                            frame_of(meadow, test_pose(meadow, 0.0, 0.0, 0.0, 0.0), 1, 0.1, 0.0, encoder));
  EXPECT_EQ(take_picture(server.port(), "no/such/folder/picture.png", {"--frames", "1"}).code, 73);
}

TEST_F(PictureTest, EndsWith69AndSaysWhatToDoWhereThereIsNoDisplay) {
  const Ended ended = run_without_screen({});
  EXPECT_EQ(ended.code, 69);
  EXPECT_THAT(ended.said, testing::HasSubstr("yuragi-viewer --screenshot"));
}

TEST_F(PictureTest, EndsWith69AndNamesThePackagesWhereNothingCanDraw) {
  std::vector<std::string> environment = environment_without_screen();
  environment.emplace_back("__EGL_VENDOR_LIBRARY_FILENAMES=/nonexistent");
  const Ended ended = run({test::built_path("bin/yuragi-viewer"), "--screenshot", (folder_ / "none.png").string()},
                          folder_, environment);
  EXPECT_EQ(ended.code, 69);
  EXPECT_THAT(ended.said, testing::HasSubstr("libegl-mesa0"));
}

TEST_F(PictureTest, EndsWith64ForAPictureThatItCannotWriteAndNamesThoseThatItCan) {
  const Ended ended = run_without_screen({"--screenshot", (folder_ / "x.gif").string()});
  EXPECT_EQ(ended.code, 64);
  EXPECT_THAT(ended.said, testing::HasSubstr(".png, .jpg or .jpeg"));
}

TEST_F(PictureTest, EndsWith64ForAWrongCommandLine) {
  EXPECT_EQ(run_without_screen({"--size", "12"}).code, 64);
  EXPECT_EQ(run_without_screen({"--connect", "here:there"}).code, 64);
  EXPECT_EQ(run_without_screen({"--camera", "1,2"}).code, 64);
  EXPECT_EQ(run_without_screen({"--help"}).code, 0);
}

}  // namespace
}  // namespace yuragi::viewer
