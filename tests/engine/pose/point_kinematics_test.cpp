#include <vector>

#include <gtest/gtest.h>

#include "engine/pose/kinematics.hpp"
#include "engine/pose/pose_arrays.hpp"

namespace yuragi::pose {
namespace {

/// Two rings, one within another, in each of three rows.
SurfaceSkeleton nested_rings() {
  SurfaceSkeleton surface;
  surface.columns = 4;
  surface.rows = 3;
  surface.is_closed = true;
  surface.shells = 2;
  surface.axis_x_m = {0.0F, 0.5F, 0.0F};
  surface.axis_z_m = {0.0F, 0.0F, 0.25F};
  for (std::size_t i = 0; i < 12; ++i) {
    surface.rest_x_m.push_back(i % 2 == 0 ? 1.0F : -1.0F);
    surface.rest_y_m.push_back(static_cast<float>(i / 4));
    surface.rest_z_m.push_back(0.25F * static_cast<float>(i % 4));
    surface.normal_x.push_back(0.6F);
    surface.normal_y.push_back(0.0F);
    surface.normal_z.push_back(-0.8F);
  }
  return surface;
}

TEST(SurfaceKinematics, APointGoesAlongItsNormalAndThenWithItsRow) {
  const Skeleton skeleton = nested_rings();
  const auto& surface = std::get<SurfaceSkeleton>(skeleton);
  Pose pose = rest_pose(skeleton);
  auto& moved = std::get<SurfacePose>(pose);
  ASSERT_EQ(moved.row_drop_m.size(), 3U);
  for (std::size_t i = 0; i < 12; ++i) moved.displacement_m[i] = 0.1F * static_cast<float>(i);
  moved.row_east_m = {0.0F, 2.0F, 4.0F};
  moved.row_south_m = {0.0F, -1.0F, -3.0F};
  moved.row_drop_m = {0.0F, 0.5F, 1.5F};
  moved.row_slope_east = {0.0F, 0.5F, 1.0F};
  moved.row_slope_south = {0.0F, 0.25F, -0.5F};
  Kinematics kinematics(skeleton);
  ASSERT_TRUE(kinematics.run(pose));
  for (std::size_t i = 0; i < 12; ++i) {
    const JointPosition at = kinematics.joint(i);
    const std::size_t row = i / 4;
    const float x_m = surface.rest_x_m[i] + 0.6F * moved.displacement_m[i];
    const float z_m = surface.rest_z_m[i] - 0.8F * moved.displacement_m[i];
    const float down_m = moved.row_slope_east[row] * (x_m - surface.axis_x_m[row]) +
                         moved.row_slope_south[row] * (z_m - surface.axis_z_m[row]);
    EXPECT_FLOAT_EQ(at.x_m, x_m + moved.row_east_m[row]) << i;
    EXPECT_FLOAT_EQ(at.y_m, surface.rest_y_m[i] - moved.row_drop_m[row] - down_m) << i;
    EXPECT_FLOAT_EQ(at.z_m, z_m + moved.row_south_m[row]) << i;
  }
}

TEST(SurfaceKinematics, RowsMoveWhereTheSkeletonSaysSoAndNowhereElse) {
  Skeleton skeleton = nested_rings();
  const Pose with_rows = rest_pose(skeleton);
  EXPECT_TRUE(fits(with_rows, skeleton));
  EXPECT_TRUE(Kinematics(skeleton).run(with_rows));
  Pose one_missing = with_rows;
  std::get<SurfacePose>(one_missing).row_south_m.pop_back();
  EXPECT_FALSE(fits(one_missing, skeleton));
  EXPECT_FALSE(Kinematics(skeleton).run(one_missing));

  std::get<SurfaceSkeleton>(skeleton).axis_x_m.clear();
  EXPECT_FALSE(Kinematics(skeleton).run(with_rows)) << "half an axis";
  std::get<SurfaceSkeleton>(skeleton).axis_z_m.clear();
  const Pose without = rest_pose(skeleton);
  EXPECT_TRUE(std::get<SurfacePose>(without).row_east_m.empty());
  EXPECT_TRUE(Kinematics(skeleton).run(without));
  EXPECT_FALSE(fits(with_rows, skeleton));
  EXPECT_FALSE(Kinematics(skeleton).run(with_rows));
}

}  // namespace
}  // namespace yuragi::pose
