#include "tests/answer/tracks.hpp"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

namespace yuragi::answer {
namespace {

/// Two joints of which the second hangs a metre below the first and swings to the east by a sine of 1 Hz.
JointTracks swinging() {
  pose::GridSkeleton grid;
  grid.columns = 1;
  grid.rows = 2;
  for (auto* axis : {&grid.rest_x_m, &grid.rest_y_m, &grid.rest_z_m}) axis->assign(2 * grid.stride(), 0.0F);
  grid.rest_y_m[grid.stride()] = -1.0F;
  const pose::Skeleton skeleton = grid;
  pose::Kinematics joints(skeleton);
  JointTracks tracks({0, 1});
  pose::GridPose pose;
  for (auto* axis : {&pose.offset_x_m, &pose.offset_y_m, &pose.offset_z_m}) axis->assign(2 * grid.stride(), 0.0F);
  for (int tick = 0; tick < 600; ++tick) {
    pose.offset_x_m[grid.stride()] = static_cast<float>(0.1 * std::sin(2.0 * std::numbers::pi * tick / 60.0));
    joints.run(pose::Pose(pose));
    tracks.take(joints);
  }
  return tracks;
}

TEST(JointTracks, SpeedIsTheRootMeanSquareOfTheVelocity) {
  const JointTracks tracks = swinging();
  EXPECT_NEAR(tracks.speed_m_s(1, 60.0), 0.1 * 2.0 * std::numbers::pi / std::sqrt(2.0), 1e-3);
  EXPECT_NEAR(tracks.largest_step_m(), 0.1 * 2.0 * std::numbers::pi / 60.0, 1e-4);
  EXPECT_EQ(tracks.speed_m_s(0, 60.0), 0.0);
}

TEST(JointTracks, AnglesAreFromStraightDownAndWaysAlongADirection) {
  const JointTracks tracks = swinging();
  EXPECT_NEAR(static_cast<double>(tracks.angle_from_down_deg(0, 1)[15]), std::atan(0.1) * 180.0 / std::numbers::pi,
              1e-4);
  EXPECT_NEAR(static_cast<double>(tracks.way_m(0, 1, {1.0, 0.0})[15]), 0.1, 1e-6);
  EXPECT_NEAR(static_cast<double>(tracks.way_m(0, 1, {0.0, 1.0})[15]), 0.0, 1e-6);
}

TEST(Differences, AreWhatIsNotCommonAndNotOwnMean) {
  // Two that differ by 2 sin, each about a mean of its own, and both follow the same slow swing.
  std::vector<Series> series(2);
  for (int i = 0; i < 6000; ++i) {
    const double common = 5.0 * std::sin(0.01 * i);
    const double own = std::sin(2.0 * std::numbers::pi * i / 60.0);
    series[0].push_back(static_cast<float>(10.0 + common + own));
    series[1].push_back(static_cast<float>(-30.0 + common - own));
  }
  EXPECT_NEAR(difference_at_one_moment(series), std::sqrt(0.5), 1e-3);
  EXPECT_NEAR(mean(mean_at_each_moment(series)), -10.0, 0.2);
}

TEST(Spread, TakesTheFirstAndTheLast) {
  EXPECT_EQ(spread(100, 3), (std::vector<std::size_t>{0, 49, 99}));
  EXPECT_EQ(spread(2, 10), (std::vector<std::size_t>{0, 1}));
  EXPECT_TRUE(spread(0, 10).empty());
}

}  // namespace
}  // namespace yuragi::answer
