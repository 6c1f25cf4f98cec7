// What a window's user and the sender's clock do to the camera, without OpenGL.
#include "viewer/picture/picture_director.hpp"

#include <gtest/gtest.h>

#include "viewer/picture/null_renderer.hpp"

namespace yuragi::viewer::picture {
namespace {

constexpr double kPicture_s = 1.0 / 60.0;
constexpr double kClock_s = 1e9;

wire::Sensors status_with(std::vector<look::Camera> cameras) {
  wire::Sensors status;
  status.cameras = std::move(cameras);
  return status;
}

class PictureDirectorTest : public testing::Test {
 protected:
  void advance(double duration_s, double utc_s) {
    for (double passed_s = 0.0; passed_s < duration_s; passed_s += kPicture_s) director_.advance(kPicture_s, utc_s, {});
  }

  ViewerOptions options_;
  NullRenderer renderer_{1280, 720};
  Director director_{options_, renderer_, "wall:4748"};
};

TEST_F(PictureDirectorTest, TheHandBeginsWhereThePictureIs) {
  director_.set_scenes({});
  director_.take_status(status_with({{.name = "shore", .target_x_m = 3.0, .heading_deg = 77.0}}));
  EXPECT_EQ(director_.camera_text(), "camera shore");
  EXPECT_EQ(director_.heading_deg(), 77.0);

  EXPECT_EQ(director_.take_camera().place().target_m.x, 3.0);
  EXPECT_EQ(director_.camera_text(), "camera by hand");
  EXPECT_EQ(director_.heading_deg(), 77.0);

  director_.reset_camera();
  advance(0.5, kClock_s);
  EXPECT_EQ(director_.camera_text(), "camera shore, cross-fading");
  advance(2.0, kClock_s);
  EXPECT_EQ(director_.camera_text(), "camera shore");
}

TEST_F(PictureDirectorTest, AnotherChoiceOfScenesIsFramedByHandUntilAllAreChosenAgain) {
  director_.take_status(status_with({{.name = "shore"}}));
  director_.frame_scenes(false);
  EXPECT_EQ(director_.camera_text(), "camera by hand");
  director_.frame_scenes(true);
  advance(2.0, kClock_s);
  EXPECT_EQ(director_.camera_text(), "camera shore");
}

TEST_F(PictureDirectorTest, GoesOnWithoutACrossFadeWhileNoFrameSaysTheTime) {
  director_.take_status(status_with({{.name = "turning", .heading_deg = 0.0, .turn_deg_min = 6.0}}));
  advance(1.0, 0.0);
  EXPECT_EQ(director_.camera_text(), "camera turning") << "no frame yet: its clock is not one of 1970";
  director_.advance(kPicture_s, kClock_s, {});
  const double heading_deg = director_.heading_deg();
  for (int second = 0; second < 60; ++second) {
    advance(1.0, kClock_s);
    ASSERT_EQ(director_.camera_text(), "camera turning") << second;
  }
  EXPECT_NEAR(director_.heading_deg(), heading_deg + 6.0, 0.1);
}

TEST_F(PictureDirectorTest, ACameraWithAWindAngleFollowsTheWindOfTheFrames) {
  director_.take_status(status_with({{.name = "across", .heading_deg = 10.0, .wind_angle_deg = 75.0}}));
  director_.advance(kPicture_s, kClock_s, {});
  EXPECT_EQ(director_.heading_deg(), 10.0) << "no frame has reported the direction";
  stream::PoseMoment moment;
  moment.view_wind_from_deg = 240.0;
  director_.draw(moment);
  EXPECT_EQ(director_.heading_deg(), 315.0);
  moment.view_wind_from_deg = 240.5;
  director_.draw(moment);
  director_.advance(kPicture_s, kClock_s, {});
  EXPECT_EQ(director_.heading_deg(), 315.5);
  EXPECT_EQ(director_.camera_text(), "camera across") << "it turns, and does not cross-fade";
}

}  // namespace
}  // namespace yuragi::viewer::picture
