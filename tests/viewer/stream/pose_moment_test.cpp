#include "viewer/stream/pose_moment.hpp"

#include <gtest/gtest.h>

#include "engine/pose/pose_arrays.hpp"
#include "tests/viewer/test_models.hpp"
#include "viewer/stream/pose_timeline.hpp"

namespace yuragi::viewer::stream {
namespace {

/// A moment of the garden: each number of each pose is its own place in the order, times `factor`.
PoseMoment numbered(const std::vector<wire::SceneModel>& scenes, float factor, float opacity) {
  PoseMoment moment = rest_moment(scenes);
  float number = 0.0F;
  for (pose::Pose& pose : moment.poses) {
    pose::for_each_array(pose, [&](std::span<float> values) {
      for (float& value : values) value = factor * ++number;
    });
  }
  moment.opacities.assign(scenes.size(), opacity);
  return moment;
}

class AllKindsTest : public testing::Test {
 protected:
  const std::vector<wire::SceneModel> garden_ = test_garden();

  /// A frame of the garden in which only the last scene may be hidden.
  wire::Frame frame(double time_s, float factor, float last_opacity) const {
    PoseMoment moment = numbered(garden_, factor, 1.0F);
    wire::Frame frame;
    frame.info.time_s = time_s;
    frame.poses = moment.poses;
    frame.opacities = moment.opacities;
    frame.opacities.back() = last_opacity;
    if (last_opacity == 0.0F) frame.poses.back() = pose::StrandPose{};  // as it is decoded
    return frame;
  }
};

TEST_F(AllKindsTest, RestInStillAirAndAreAllThere) {
  const PoseMoment rest = rest_moment(garden_);
  ASSERT_EQ(rest.poses.size(), garden_.size());
  for (std::size_t i = 0; i < garden_.size(); ++i) {
    EXPECT_TRUE(pose::fits(rest.poses[i], garden_[i].skeleton)) << garden_[i].name;
    EXPECT_EQ(rest.opacities.at(i), 1.0F);
  }
}

TEST_F(AllKindsTest, TheWindsPlaceGoesFromOneMomentToTheNext) {
  PoseMoment a = rest_moment(garden_);
  PoseMoment b = a;
  a.wind.upwind_m = 4.0;
  a.wind.to_middle_s = 1.0;
  b.wind.upwind_m = 8.0;
  b.wind.to_middle_s = 3.0;
  b.wind.is_place_configured = true;
  PoseMoment out = rest_moment(garden_);
  blend(a, b, 0.25, out);
  EXPECT_EQ(out.wind.upwind_m, 5.0);
  EXPECT_EQ(out.wind.to_middle_s, 1.5);
  EXPECT_FALSE(out.wind.is_place_configured);
  blend(a, b, 0.75, out);
  EXPECT_TRUE(out.wind.is_place_configured);
}

TEST_F(AllKindsTest, AreBlendedNumberByNumber) {
  const PoseMoment a = numbered(garden_, 1.0F, 0.0F);
  const PoseMoment b = numbered(garden_, 3.0F, 1.0F);
  PoseMoment out = rest_moment(garden_);
  blend(a, b, 0.25, out);
  float number = 0.0F;
  for (const pose::Pose& pose : out.poses) {
    pose::for_each_array(pose, [&](std::span<const float> values) {
      for (const float value : values) {
        number += 1.0F;
        ASSERT_EQ(value, 1.5F * number);
      }
    });
  }
  for (const float opacity : out.opacities) EXPECT_EQ(opacity, 0.25F);
}

TEST_F(AllKindsTest, HaveALayoutOfTheirOwnEach) {
  const PoseMoment all = rest_moment(garden_);
  EXPECT_TRUE(has_same_layout(all.poses, numbered(garden_, 2.0F, 1.0F).poses));
  for (std::size_t i = 0; i < garden_.size(); ++i) {
    PoseMoment other = all;
    std::swap(other.poses[i], other.poses[(i + 1) % garden_.size()]);
    EXPECT_FALSE(has_same_layout(all.poses, other.poses)) << garden_[i].name;
  }
}

TEST_F(AllKindsTest, AreHeldByTheHistoryAndSampledBetween) {
  PoseHistory history;
  history.reset(rest_moment(garden_));
  for (int i = 0; i < 3; ++i) {
    PoseMoment moment = numbered(garden_, static_cast<float>(i), 0.5F * static_cast<float>(i));
    moment.time_s = i;
    history.push(moment);
  }
  PoseMoment out = rest_moment(garden_);
  history.sample(1.5, out);
  const PoseMoment expected = numbered(garden_, 1.5F, 0.75F);
  for (std::size_t i = 0; i < garden_.size(); ++i) {
    EXPECT_EQ(out.opacities[i], 0.75F);
    const pose::Arrays<const float> got(out.poses[i]);
    const pose::Arrays<const float> wanted(expected.poses[i]);
    for (std::size_t array = 0; array < got.size(); ++array) {
      for (std::size_t n = 0; n < got[array].size(); ++n) ASSERT_EQ(got[array][n], wanted[array][n]);
    }
  }
}

TEST_F(AllKindsTest, ComeBackFromHidingWithoutAJump) {
  PoseTimeline timeline;
  timeline.set_scenes(garden_);
  double local_s = 100.0;
  double largest_step = 0.0;
  float last = 1.0F;
  bool was_hidden = false;
  for (int tick = 0; tick < 240; ++tick) {
    // The last scene fades out over a second, sends no poses for one, and fades in again.
    const auto t = static_cast<float>(tick) / 60.0F;
    const float opacity = t < 1.0F ? 1.0F - t : (t < 2.0F ? 0.0F : std::min(1.0F, t - 2.0F));
    wire::Frame sent = frame(10.0 + tick / 60.0, 1.0F, opacity);
    ASSERT_TRUE(timeline.accept(sent, local_s));
    local_s += 1.0 / 60.0;
    const PoseMoment& shown = timeline.advance(local_s);
    ASSERT_TRUE(pose::fits(shown.poses.back(), garden_.back().skeleton));
    largest_step = std::max(largest_step, static_cast<double>(std::abs(shown.opacities.back() - last)));
    last = shown.opacities.back();
    was_hidden = was_hidden || last == 0.0F;
    EXPECT_EQ(shown.opacities.front(), 1.0F);
  }
  EXPECT_TRUE(was_hidden);
  EXPECT_GT(last, 0.9F);
  EXPECT_LE(largest_step, PoseTrack::kMaxPlayRate / 60.0 + 1e-5);
}

TEST_F(AllKindsTest, AreRefusedWhereAShownSceneHasNoPose) {
  PoseTimeline timeline;
  timeline.set_scenes(garden_);
  wire::Frame sent = frame(10.0, 1.0F, 0.0F);
  sent.opacities.back() = 0.5F;
  EXPECT_FALSE(timeline.accept(sent, 100.0));
}

}  // namespace
}  // namespace yuragi::viewer::stream
