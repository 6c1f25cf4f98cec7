// The loop of a film, without a replay, without OpenGL and without a file.
#include "viewer/film/film.hpp"

#include <deque>
#include <functional>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "viewer/film/film_progress.hpp"
#include "viewer/picture/null_renderer.hpp"
#include "viewer/picture/viewer_exit.hpp"

namespace yuragi::viewer::film {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

constexpr double kTick_s = 0.25;

wire::SceneModel patch(const std::string& name) {
  pose::StrandSkeleton strands;
  strands.strand_count = 1;
  strands.links_per_strand = 2;
  const std::vector<float> zeros(strands.padded_count());
  const std::vector<float> ones(strands.padded_count(), 1.0F);
  strands.root_x_m = strands.root_y_m = strands.root_z_m = zeros;
  strands.rest_x = strands.rest_z = strands.curl_y = strands.curl_z = strands.rest_curl_rad = zeros;
  strands.rest_y = strands.curl_x = strands.link_length_m = ones;
  return {name, "grass", strands};
}

/// The first strand bends by the time.
wire::Frame frame_at(double time_s) {
  wire::Frame frame;
  frame.info.time_s = time_s;
  frame.info.utc_ns = static_cast<std::int64_t>(1e9 * (1e6 + time_s));
  const std::vector<float> bends(pose::padded_to_blocks(1), static_cast<float>(time_s));
  frame.poses.emplace_back(pose::StrandPose{bends, bends});
  frame.opacities.push_back(1.0F);
  return frame;
}

class ToldStream final : public Stream {
 public:
  std::optional<wire::Message> next() override {
    if (messages.empty()) return std::nullopt;
    auto message = std::move(messages.front());
    messages.pop_front();
    return message;
  }
  std::deque<wire::Message> messages;
};

/// Remembers what it was to draw.
class WatchedRenderer final : public picture::Renderer {
 public:
  void set_scenes(std::vector<wire::SceneModel> scenes) override { nothing_.set_scenes(std::move(scenes)); }
  const std::vector<const wire::SceneModel*>& scenes() const override { return nothing_.scenes(); }
  void show_only(const std::string& /*scene*/) override {}
  double aspect() const override { return nothing_.aspect(); }
  meshes::CameraPlace home(double wind_from_deg) const override { return nothing_.home(wind_from_deg); }
  meshes::CameraPlace outside(const meshes::CameraPlace& place) const override { return place; }
  std::optional<meshes::Bounds> bounds_of(std::string_view scene) const override { return nothing_.bounds_of(scene); }
  void set_light(const light::Light& /*light*/) override {}
  void set_quality(look::Quality quality, float /*density*/) override { quality_ = quality; }
  void draw(const picture::Picture& picture) override {
    bends.push_back(std::get<pose::StrandPose>(picture.moment.poses.at(0)).bend_east_rad.at(0));
    headings_deg.push_back(picture.camera.heading_deg);
  }
  std::vector<std::uint8_t> read_rgb() override { return nothing_.read_rgb(); }

  std::vector<float> bends;
  std::vector<double> headings_deg;
  look::Quality quality_ = look::Quality::kAuto;

 private:
  picture::NullRenderer nothing_{16, 16};
};

class CountedOutput final : public Output {
 public:
  void write(std::span<const std::uint8_t> rgb) override { bytes += rgb.size(); }
  void finish() override {}
  std::string text() const override { return {}; }
  std::size_t bytes = 0;
};

class FilmTest : public testing::Test {
 protected:
  FilmTest() {
    options_.render = "folder/wind.windlog";
    options_.width_px = options_.height_px = 16;
    stream_.messages = {wire::Hello{}, wire::Scenes{{patch("patch")}}};
  }

  void send_frames(int count) {
    for (int i = 0; i < count; ++i) stream_.messages.emplace_back(frame_at(100.0 + kTick_s * i));
  }

  bool make() {
    return make_film(
        options_, stream_, renderer_, output_, [this](int, std::optional<int> total) { total_ = total; }, is_stopping_);
  }

  std::string failure() {
    try {
      make();
      return {};
    } catch (const picture::ViewerExit& exit) {
      return exit.what();
    }
  }

  picture::ViewerOptions options_;
  ToldStream stream_;
  WatchedRenderer renderer_;
  CountedOutput output_;
  std::atomic<bool> is_stopping_{false};
  std::optional<int> total_;
};

TEST_F(FilmTest, HasAPictureAtEachOfItsMomentsFromTheFirstFrameToTheLast) {
  options_.fps = 8.0;
  send_frames(3);
  EXPECT_TRUE(make());
  EXPECT_THAT(renderer_.bends, ElementsAre(100.0F, 100.125F, 100.25F, 100.375F, 100.5F));
  EXPECT_EQ(output_.bytes, 5U * 3U * 16U * 16U);
}

TEST_F(FilmTest, FewerPicturesThanTicksLeaveNoneOutThatIsDue) {
  options_.fps = 1.0;
  options_.duration_s = 2.0;
  send_frames(100);
  EXPECT_TRUE(make());
  EXPECT_THAT(renderer_.bends, ElementsAre(100.0F, 101.0F));
  EXPECT_EQ(total_, 2);
}

TEST_F(FilmTest, SaysHowManyPicturesThereWillBeWhereTheReplayKnowsIt) {
  options_.fps = 4.0;
  wire::PlayerState player;
  player.length_s = 10.0;
  stream_.messages.emplace_back(wire::ControlReply{.done = true, .message = {}, .scenes = {}, .players = {player}});
  send_frames(4);
  EXPECT_TRUE(make());
  EXPECT_EQ(total_, 40);
}

TEST_F(FilmTest, TheCameraOfTheRecordedHourMovesByTheRecordedClock) {
  options_.fps = 4.0;
  wire::Sensors status;
  status.look.quality = look::Quality::kMedium;
  status.cameras = {{.name = "turning", .turn_deg_min = 60.0}};
  stream_.messages.emplace_back(status);
  send_frames(3);
  EXPECT_TRUE(make());
  ASSERT_EQ(renderer_.headings_deg.size(), 3U);
  EXPECT_NEAR(renderer_.headings_deg[1] - renderer_.headings_deg[0], 0.25, 1e-6);
  EXPECT_NEAR(renderer_.headings_deg[2] - renderer_.headings_deg[1], 0.25, 1e-6);
  EXPECT_EQ(renderer_.quality_, look::Quality::kMedium);
}

TEST_F(FilmTest, ScenesThatChangeUnderItAreShownFromTheirFirstFrameOn) {
  options_.fps = 4.0;
  send_frames(2);
  stream_.messages.emplace_back(wire::Scenes{{patch("another")}});
  stream_.messages.emplace_back(frame_at(100.5));
  EXPECT_TRUE(make());
  EXPECT_THAT(renderer_.bends, ElementsAre(100.0F, 100.25F, 100.5F));
}

TEST_F(FilmTest, AStreamThatItCannotShowIsSaid) {
  stream_.messages = {wire::Hello{.protocol = 99, .software = "yuragi 9"}};
  EXPECT_THAT(failure(), HasSubstr("wind.windlog (yuragi 9) speaks protocol 99"));
  stream_.messages = {wire::Scenes{{patch("patch"), patch("another")}}, frame_at(1.0)};
  EXPECT_THAT(failure(), HasSubstr("does not fit the scenes"));
  stream_.messages = {frame_at(1.0)};
  EXPECT_THAT(failure(), HasSubstr("does not fit the scenes")) << "there are none";
  options_.scene = "tree";
  stream_.messages = {wire::Scenes{{patch("patch"), patch("another")}}};
  EXPECT_THAT(failure(), HasSubstr("wind.windlog has no scene 'tree'; it has: patch, another"));
}

TEST_F(FilmTest, ARecordingWithoutAMomentIsNoFilm) {
  EXPECT_FALSE(make());
  EXPECT_EQ(output_.bytes, 0U);
}

TEST(FilmProgressText, SaysHowLongItTakesYet) {
  EXPECT_EQ(film_progress_text(0, std::nullopt, 0.0), "picture 0");
  EXPECT_EQ(film_progress_text(30, std::nullopt, 10.0), "picture 30, 3.0 a second");
  EXPECT_EQ(film_progress_text(10, 600, 100.0), "picture 10 of 600, 10.0 s each, 1:38:20 left");
  EXPECT_EQ(film_progress_text(300, 600, 229.0), "picture 300 of 600, 1.3 a second, 3:49 left");
  EXPECT_EQ(film_progress_text(600, 600, 300.0), "picture 600 of 600, 2.0 a second, 0:00 left");
}

TEST(FilmName, IsAVideoAFolderOrStandardOutput) {
  for (const char* name : {"-", "take.mp4", "a/take.mp4", "pictures", "a/pictures/", "/tmp"}) {
    EXPECT_EQ(check_film_name(name), "") << name;
  }
  for (const char* name : {"", "take.gif", "a.b/take.avi", "picture.png"}) EXPECT_NE(check_film_name(name), "") << name;
}

}  // namespace
}  // namespace yuragi::viewer::film
