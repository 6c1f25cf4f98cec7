#include "viewer/meshes/partings.hpp"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "engine/pose/pose_arrays.hpp"
#include "tests/viewer/test_models.hpp"

namespace yuragi::viewer::meshes {
namespace {

constexpr float kWave_m = 0.4F;

class PartingsTest : public testing::Test {
 protected:
  const wire::SceneModel model_ = test_model("fur");
  const pose::StrandSkeleton& coat_ = std::get<pose::StrandSkeleton>(model_.skeleton);
  Partings partings_{coat_, body_of(coat_)};
  pose::JointPositions joints_{coat_};

  /// Of hairs on the back that are bent eastward by so much, in waves from west to east that have gone on by a part.
  void bend(float strength_rad, float part) {
    pose::Pose pose = pose::rest_pose(coat_);
    auto& bends = std::get<pose::StrandPose>(pose);
    for (std::size_t i = 0; i < coat_.strand_count; ++i) {
      bends.bend_east_rad[i] = strength_rad * std::sin(phase_rad(i, part));
    }
    const pose::StrandKinematicsJob job{.skeleton = &coat_, .pose = &bends, .row = {}, .joints = &joints_};
    ASSERT_EQ(job.run(), pose::StrandKinematicsJob::Problem::kNone);
    partings_.move_to(joints_);
  }

  float phase_rad(std::size_t i, float part) const { return 6.2831853F * (coat_.root_x_m[i] / kWave_m - part); }

  /// The mean opening where the bends grow toward the east, and so tips go apart.
  float mean_where_apart(float part) const {
    float sum = 0.0F;
    float count = 0.0F;
    for (std::size_t i = 0; i < coat_.strand_count; ++i) {
      if (coat_.root_y_m[i] < 0.65F || std::cos(phase_rad(i, part)) < 0.7F) continue;
      sum += partings_.openings()[i];
      count += 1.0F;
    }
    return sum / count;
  }
};

TEST_F(PartingsTest, AreNoneAtRest) {
  bend(0.0F, 0.0F);
  ASSERT_EQ(partings_.openings().size(), coat_.strand_count);
  for (const float opening : partings_.openings()) ASSERT_NEAR(opening, 0.0F, 1e-4F);
}

TEST_F(PartingsTest, AreWhereTipsGoApartAndRunOnWithTheWaves) {
  for (const float part : {0.0F, 0.25F, 0.5F}) {
    bend(0.3F, part);
    EXPECT_GT(mean_where_apart(part), 0.03F) << part;
    EXPECT_LT(mean_where_apart(part + 0.5F), -0.03F) << part;
  }
}

TEST_F(PartingsTest, OfNothingAreNothing) {
  Partings none({}, body_of({}));
  EXPECT_TRUE(none.openings().empty());
}

}  // namespace
}  // namespace yuragi::viewer::meshes
