#include "viewer/stream/picture_age.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace yuragi::viewer::stream {
namespace {

using testing::HasSubstr;
using testing::Not;

constexpr double kStep_s = 1.0 / 60.0;
constexpr double kUtc_s = 1e6;  // since 1970, at the viewer's second 0
constexpr double kWay_s = 0.004;
constexpr double kBehind_s = 0.025;  // the picture, behind the newest frame

wire::FrameInfo frame_of(double sender_s, double utc_s) {
  wire::FrameInfo frame;
  frame.time_s = sender_s;
  frame.utc_ns = static_cast<std::int64_t>(1e9 * utc_s);
  return frame;
}

PoseMoment live_moment(double sender_s) {
  PoseMoment moment;
  moment.time_s = sender_s;
  moment.wind.live_weight = 1.0;
  return moment;
}

/// Half a minute of frames that are kWay_s on their way, of readings that are `reading_s` old in each, and pictures of
/// them. The daemon's clock is `ahead_s` of ours.
AgeFigures age_of(double reading_s, bool is_same_machine, double ahead_s = 0.0, double display_s = kStep_s) {
  PictureAge age;
  for (int i = 0; i < 1800; ++i) {
    const double sender_s = i * kStep_s;
    const double made_s = 50.0 + sender_s;
    const wire::FrameInfo frame = frame_of(sender_s, kUtc_s + made_s + ahead_s);
    age.take_frame(frame, made_s + kWay_s, kUtc_s + made_s + kWay_s, is_same_machine);
    PoseMoment moment = live_moment(sender_s - kBehind_s);
    moment.wind.reading_age_s = reading_s;
    age.take_picture(moment, made_s + kWay_s, display_s);
  }
  return age.figures(50.0 + 1800 * kStep_s).value_or(AgeFigures{});
}

TEST(PictureAge, IsExactWhereTheDaemonRunsOnThisMachine) {
  const AgeFigures age = age_of(0.010, true);
  EXPECT_NEAR(age.p50_s, 0.010 + kBehind_s + kWay_s + kStep_s, 1e-6);
  EXPECT_NEAR(age.max_s, age.p50_s, 1e-6);
  EXPECT_NEAR(static_cast<double>(age.pictures), 600.0, 1.0);
  EXPECT_TRUE(age.is_network_known);
  EXPECT_THAT(age_text(age),
              HasSubstr("reading 56 ms old when it was shown (of 10 s: p50 56, p95 56, at most 56 ms; 17 ms"));
  EXPECT_THAT(age_text(age), Not(HasSubstr("network")));
}

TEST(PictureAge, GrowsByWhatTheReadingIsOlder) {
  EXPECT_NEAR(age_of(0.250, true).p50_s - age_of(0.0, true).p50_s, 0.250, 1e-6);
}

TEST(PictureAge, OfAnotherMachineBeginsWithTheArrivalAndSaysSo) {
  for (const double ahead_s : {-3600.0, -0.5, 0.0, 0.5, 3600.0}) {
    const AgeFigures age = age_of(0.010, false, ahead_s);
    EXPECT_NEAR(age.p50_s, 0.010 + kBehind_s + kStep_s, 1e-3) << "whatever the other's clock says";
    EXPECT_FALSE(age.is_network_known);
    EXPECT_THAT(age_text(age), HasSubstr("without the way through the network"));
  }
}

TEST(PictureAge, DoesNotTrustAClockThatCannotBeThisMachines) {
  // As through a tunnel, whose end is here.
  EXPECT_FALSE(age_of(0.010, true, 0.5).is_network_known);
  EXPECT_FALSE(age_of(0.010, true, -60.0).is_network_known);
}

TEST(PictureAge, IsNoneWithoutASensorAndForgottenAfterTenSeconds) {
  PictureAge age;
  PoseMoment moment = live_moment(1.0);
  age.take_picture(moment, 1.0, 0.0);
  EXPECT_FALSE(age.figures(1.0)) << "no frame has come";
  age.take_frame(frame_of(1.0, 1.0), 1.0, 1.0, true);
  moment.wind.live_weight = 0.0;
  age.take_picture(moment, 1.0, 0.0);
  EXPECT_FALSE(age.figures(1.0));
  moment.wind.live_weight = 1.0;
  age.take_picture(moment, 1.5, 0.0);
  EXPECT_NEAR(age.figures(2.0).value().p50_s, 0.5, 1e-9);
  EXPECT_FALSE(age.figures(12.0));
}

TEST(PictureAge, BeginsAnewWithADaemonThatWasRestarted) {
  PictureAge age;
  PoseMoment moment = live_moment(1000.0);
  age.take_frame(frame_of(1000.0, 0.0), 50.0, 1e9, false);
  age.take_picture(moment, 50.1, 0.0);
  age.take_frame(frame_of(0.0, 0.0), 51.0, 1e9, false);
  EXPECT_FALSE(age.figures(51.0));
  moment.time_s = 0.0;
  age.take_picture(moment, 51.2, 0.0);
  EXPECT_NEAR(age.figures(51.2).value().max_s, 0.2, 1e-9);
}

}  // namespace
}  // namespace yuragi::viewer::stream
