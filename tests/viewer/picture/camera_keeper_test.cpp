#include "viewer/picture/camera_keeper.hpp"

#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace yuragi::viewer::picture {
namespace {

const std::vector<look::Camera> kCameras{{.name = "day", .fade_s = 10.0}, {.name = "night", .fade_s = 20.0}};

/// Has the first and is told of the hour's.
CameraKeeper with(const std::vector<look::Camera>& cameras, std::size_t on = 0) {
  CameraKeeper keeper;
  keeper.hear_clock(1000.0);
  keeper.set_cameras(cameras, on);
  keeper.advance(0.0);
  return keeper;
}

TEST(CameraKeeper, IsByHandWithoutCameras) {
  CameraKeeper keeper = with({});
  keeper.next();
  keeper.advance(1.0);
  EXPECT_FALSE(keeper.now().camera);
  EXPECT_FALSE(keeper.is_fading());
  EXPECT_FALSE(keeper.reset());
}

TEST(CameraKeeper, BeginsWithTheHoursAtOnce) {
  const CameraKeeper keeper = with(kCameras, 1);
  EXPECT_EQ(keeper.now().name(), "night");
  EXPECT_FALSE(keeper.is_fading());
  EXPECT_EQ(keeper.share(), 1.0);
}

TEST(CameraKeeper, CrossFadesWhenTheHourComes) {
  CameraKeeper keeper = with(kCameras);
  keeper.set_cameras(kCameras, 1);
  keeper.advance(0.0);
  EXPECT_EQ(keeper.before().name(), "day");
  EXPECT_EQ(keeper.now().name(), "night");
  EXPECT_EQ(keeper.share(), 0.0);
  double last = 0.0;
  for (int i = 0; i < 200; ++i) {
    keeper.advance(0.1);
    EXPECT_GE(keeper.share(), last);
    EXPECT_LT(keeper.share() - last, 0.02);
    last = keeper.share();
    if (i < 198) {
      EXPECT_TRUE(keeper.is_fading()) << "it takes the 20 s of the night's";
    }
  }
  EXPECT_EQ(keeper.share(), 1.0);
}

TEST(CameraKeeper, LetsACrossFadeEndBeforeTheNext) {
  CameraKeeper keeper = with(kCameras);
  keeper.set_cameras(kCameras, 1);
  keeper.advance(0.0);
  keeper.advance(5.0);
  keeper.set_cameras(kCameras, 0);
  keeper.advance(5.0);
  EXPECT_EQ(keeper.now().name(), "night");
  keeper.advance(10.0);
  EXPECT_EQ(keeper.now().name(), "day") << "now it begins";
  EXPECT_EQ(keeper.before().name(), "night");
  EXPECT_EQ(keeper.share(), 0.0);
}

TEST(CameraKeeper, StaysWithTheOneThatWasAskedFor) {
  CameraKeeper keeper;
  keeper.begin_with("night");
  keeper.hear_clock(1000.0);
  keeper.set_cameras(kCameras, 0);
  keeper.advance(0.0);
  EXPECT_EQ(keeper.now().name(), "night");
  EXPECT_TRUE(keeper.has("night"));
  EXPECT_FALSE(keeper.has("dawn"));
  keeper.set_cameras({kCameras[0]}, 0);
  keeper.advance(0.0);
  EXPECT_EQ(keeper.now().name(), "day") << "it is gone: the hour's";
}

TEST(CameraKeeper, GoesThroughAllOfThemByKeyAndBackToTheHours) {
  CameraKeeper keeper = with(kCameras, 1);
  keeper.next();
  keeper.advance(0.0);
  EXPECT_EQ(keeper.now().name(), "day");
  EXPECT_TRUE(keeper.is_fading());
  keeper.advance(CameraKeeper::kFade_s);
  EXPECT_FALSE(keeper.is_fading());
  keeper.next();
  keeper.advance(0.0);
  EXPECT_EQ(keeper.now().name(), "night");
  keeper.advance(CameraKeeper::kFade_s);
  keeper.next();
  keeper.advance(0.0);
  keeper.advance(CameraKeeper::kFade_s);
  EXPECT_TRUE(keeper.reset());
  keeper.advance(0.0);
  EXPECT_EQ(keeper.now().name(), "night");
}

TEST(CameraKeeper, TheHandTakesOverAtOnceAndGivesBackByACrossFade) {
  CameraKeeper keeper = with(kCameras);
  keeper.take_by_hand();
  EXPECT_FALSE(keeper.now().camera);
  EXPECT_FALSE(keeper.is_fading());
  keeper.set_cameras(kCameras, 1);
  keeper.advance(1.0);
  EXPECT_FALSE(keeper.now().camera) << "whatever the hour";
  EXPECT_TRUE(keeper.reset());
  keeper.advance(0.0);
  EXPECT_EQ(keeper.now().name(), "night");
  EXPECT_FALSE(keeper.before().camera);
  EXPECT_TRUE(keeper.is_fading());
  keeper.take_by_hand();
  EXPECT_FALSE(keeper.is_fading()) << "the hand cannot be in two places";
}

TEST(CameraKeeper, MayBeginByHand) {
  CameraKeeper keeper;
  keeper.begin_by_hand();
  keeper.set_cameras(kCameras, 0);
  keeper.advance(0.0);
  EXPECT_FALSE(keeper.now().camera);
  keeper.next();
  keeper.advance(0.0);
  EXPECT_EQ(keeper.now().name(), "day");
  EXPECT_FALSE(keeper.reset());
}

TEST(CameraKeeper, CrossFadesToWhatTheConfigurationSaysNow) {
  CameraKeeper keeper = with(kCameras);
  std::vector<look::Camera> cameras = kCameras;
  cameras[0].heading_deg = 10.0;
  keeper.set_cameras(cameras, 0);
  keeper.advance(0.0);
  EXPECT_EQ(keeper.now().camera->heading_deg, 10.0);
  EXPECT_EQ(keeper.before().camera->heading_deg, 210.0);
  keeper.advance(CameraKeeper::kFade_s);
  EXPECT_FALSE(keeper.is_fading());
  cameras[1].heading_deg = 20.0;
  keeper.set_cameras(cameras, 0);
  keeper.advance(0.0);
  EXPECT_FALSE(keeper.is_fading()) << "another one has changed, which is not seen";
}

TEST(CameraKeeper, FollowsTheDaemonsClockEvenlyWhileFramesAreUneven) {
  CameraKeeper keeper = with(kCameras);
  double utc_s = 1000.0;
  double last_s = keeper.now().utc_s;
  for (int i = 0; i < 2000; ++i) {
    utc_s += 0.02;
    if (i % 7 == 0) keeper.hear_clock(utc_s - 0.05 * (i % 3));
    keeper.advance(0.02);
    EXPECT_NEAR(keeper.now().utc_s - last_s, 0.02, 0.0021);
    last_s = keeper.now().utc_s;
  }
  EXPECT_NEAR(keeper.now().utc_s, utc_s, 0.2);
}

TEST(CameraKeeper, GoesOnWhileNoFramesCome) {
  CameraKeeper keeper = with(kCameras);
  for (int i = 0; i < 600; ++i) keeper.advance(0.1);
  EXPECT_NEAR(keeper.now().utc_s, 1060.0, 0.01);
  EXPECT_FALSE(keeper.is_fading());
  keeper.hear_clock(1060.2);
  keeper.advance(0.1);
  EXPECT_FALSE(keeper.is_fading());
}

TEST(CameraKeeper, CrossFadesWhereTheClockWasSet) {
  CameraKeeper keeper = with(kCameras);
  keeper.hear_clock(5000.0);
  keeper.advance(0.1);
  EXPECT_TRUE(keeper.is_fading());
  EXPECT_NEAR(keeper.before().utc_s, 1000.1, 1e-6);
  EXPECT_NEAR(keeper.now().utc_s, 5000.1, 1e-6);
  keeper.advance(CameraKeeper::kFade_s);
  EXPECT_FALSE(keeper.is_fading());
}

}  // namespace
}  // namespace yuragi::viewer::picture
