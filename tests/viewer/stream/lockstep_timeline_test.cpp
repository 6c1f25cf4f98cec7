#include "viewer/stream/lockstep_timeline.hpp"

#include <array>
#include <limits>

#include <gtest/gtest.h>

namespace yuragi::viewer::stream {
namespace {

constexpr std::size_t kStrands = 3;

wire::SceneModel patch(std::size_t strands = kStrands) {
  pose::StrandSkeleton skeleton;
  skeleton.strand_count = strands;
  skeleton.links_per_strand = 2;
  skeleton.root_x_m.resize(skeleton.padded_count());
  return {"patch", "grass", skeleton};
}

wire::Frame frame_at(double time_s, float bend_rad, std::size_t strands = kStrands) {
  wire::Frame frame;
  frame.info.time_s = time_s;
  const std::vector<float> bends(pose::padded_to_blocks(strands), bend_rad);
  frame.poses.emplace_back(pose::StrandPose{bends, bends});
  frame.opacities.push_back(1.0F);
  return frame;
}

float bend_of(const PoseMoment& moment) {
  return std::get<pose::StrandPose>(moment.poses.at(0)).bend_east_rad.at(0);
}

class LockstepTimelineTest : public testing::Test {
 protected:
  LockstepTimelineTest() {
    const std::array scenes{patch()};
    timeline_.set_scenes(scenes);
  }
  bool accept(wire::Frame frame) { return timeline_.accept(frame); }

  LockstepTimeline timeline_;
};

TEST_F(LockstepTimelineTest, AMomentIsBetweenTheFramesAroundIt) {
  EXPECT_FALSE(timeline_.has_begun());
  ASSERT_TRUE(accept(frame_at(10.0, 0.2F)));
  EXPECT_FLOAT_EQ(bend_of(timeline_.at(10.0)), 0.2F);
  ASSERT_TRUE(accept(frame_at(10.5, 0.6F)));
  EXPECT_FLOAT_EQ(bend_of(timeline_.at(10.0)), 0.2F);
  EXPECT_FLOAT_EQ(bend_of(timeline_.at(10.125)), 0.3F);
  EXPECT_FLOAT_EQ(bend_of(timeline_.at(10.5)), 0.6F);
  ASSERT_TRUE(accept(frame_at(11.0, 0.0F)));
  EXPECT_FLOAT_EQ(bend_of(timeline_.at(10.75)), 0.3F);
  EXPECT_EQ(timeline_.newest_s(), 11.0);
}

TEST_F(LockstepTimelineTest, WhatIsNoNextFrameOfTheseScenesIsRefused) {
  ASSERT_TRUE(accept(frame_at(10.0, 0.2F)));
  EXPECT_FALSE(accept(frame_at(10.0, 0.3F))) << "not later";
  EXPECT_FALSE(accept(frame_at(std::numeric_limits<double>::quiet_NaN(), 0.3F)));
  EXPECT_FALSE(accept(frame_at(11.0, 0.3F, 40))) << "of other scenes";
  EXPECT_FALSE(accept(wire::Frame{}));
  EXPECT_FLOAT_EQ(bend_of(timeline_.at(10.0)), 0.2F);
}

TEST_F(LockstepTimelineTest, AHiddenSceneKeepsItsPose) {
  ASSERT_TRUE(accept(frame_at(10.0, 0.2F)));
  wire::Frame hidden = frame_at(11.0, 0.0F);
  hidden.poses[0] = pose::StrandPose{};
  EXPECT_FALSE(accept(hidden)) << "it is to be seen, and has no pose";
  hidden.opacities[0] = 0.0F;
  ASSERT_TRUE(accept(hidden));
  const PoseMoment& moment = timeline_.at(11.0);
  EXPECT_FLOAT_EQ(bend_of(moment), 0.2F);
  EXPECT_EQ(moment.opacities[0], 0.0F);
}

TEST_F(LockstepTimelineTest, OtherScenesBeginAnew) {
  ASSERT_TRUE(accept(frame_at(10.0, 0.2F)));
  const std::array scenes{patch(40)};
  timeline_.set_scenes(scenes);
  EXPECT_FALSE(timeline_.has_begun());
  EXPECT_FALSE(accept(frame_at(11.0, 0.3F)));
  EXPECT_TRUE(accept(frame_at(9.0, 0.4F, 40)));
  EXPECT_FLOAT_EQ(bend_of(timeline_.at(9.0)), 0.4F);
}

}  // namespace
}  // namespace yuragi::viewer::stream
