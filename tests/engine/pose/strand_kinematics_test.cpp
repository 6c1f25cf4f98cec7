#include "engine/pose/strand_kinematics.hpp"

#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/bits.hpp"
#include "tests/support/each_simd_row.hpp"
#include "tests/support/random_strands.hpp"

namespace yuragi::pose {
namespace {

using Problem = StrandKinematicsJob::Problem;
using Vector = std::array<double, 3>;

JointPositions joints_of(const StrandSkeleton& skeleton, const StrandPose& pose, std::optional<SimdRow> row = {}) {
  JointPositions joints(skeleton);
  EXPECT_EQ((StrandKinematicsJob{.skeleton = &skeleton, .pose = &pose, .row = row, .joints = &joints}.run()),
            Problem::kNone);
  return joints;
}

StrandPose no_bend(const StrandSkeleton& skeleton) {
  return {std::vector<float>(skeleton.padded_count()), std::vector<float>(skeleton.padded_count())};
}

Vector vector_of(JointPosition joint) {
  return {static_cast<double>(joint.x_m), static_cast<double>(joint.y_m), static_cast<double>(joint.z_m)};
}

/// `v` turned by `angle_rad` about the unit vector `axis`, by Rodrigues' formula.
Vector turned(const Vector& v, const Vector& axis, double angle_rad) {
  const double along = axis[0] * v[0] + axis[1] * v[1] + axis[2] * v[2];
  const Vector cross = {axis[1] * v[2] - axis[2] * v[1], axis[2] * v[0] - axis[0] * v[2],
                        axis[0] * v[1] - axis[1] * v[0]};
  Vector result;
  for (std::size_t i = 0; i < 3; ++i) {
    result[i] =
        v[i] * std::cos(angle_rad) + cross[i] * std::sin(angle_rad) + axis[i] * along * (1 - std::cos(angle_rad));
  }
  return result;
}

/// What skeleton.hpp says, word for word and in double: the joint behind link `link`.
Vector expected_joint(const StrandSkeleton& skeleton, const StrandPose& pose, std::size_t strand, std::size_t link) {
  const auto east = static_cast<double>(pose.bend_east_rad[strand]);
  const auto south = static_cast<double>(pose.bend_south_rad[strand]);
  const double bend_rad = std::hypot(east, south);
  const Vector axis = {south / bend_rad, 0.0, -east / bend_rad};  // up x bend
  Vector joint = {static_cast<double>(skeleton.root_x_m[strand]), static_cast<double>(skeleton.root_y_m[strand]),
                  static_cast<double>(skeleton.root_z_m[strand])};
  const Vector rest = {static_cast<double>(skeleton.rest_x[strand]), static_cast<double>(skeleton.rest_y[strand]),
                       static_cast<double>(skeleton.rest_z[strand])};
  const Vector curl = {static_cast<double>(skeleton.curl_x[strand]), static_cast<double>(skeleton.curl_y[strand]),
                       static_cast<double>(skeleton.curl_z[strand])};
  for (std::size_t k = 0; k <= link; ++k) {
    const double curled_rad = static_cast<double>(k) * static_cast<double>(skeleton.rest_curl_rad[strand]);
    Vector direction;
    for (std::size_t i = 0; i < 3; ++i) direction[i] = rest[i] * std::cos(curled_rad) + curl[i] * std::sin(curled_rad);
    if (bend_rad > 0.0) {
      const double share = static_cast<double>(k + 1) / static_cast<double>(skeleton.links_per_strand);
      direction = turned(direction, axis, bend_rad * share);
    }
    for (std::size_t i = 0; i < 3; ++i) joint[i] += static_cast<double>(skeleton.link_length_m[strand]) * direction[i];
  }
  return joint;
}

class StrandKinematicsOnEachRow : public EachSimdRow {};
YURAGI_ON_EACH_ROW(StrandKinematicsOnEachRow);

TEST_P(StrandKinematicsOnEachRow, ComputesTheSameBitsAsTheBaseRow) {
  for (const std::size_t links : {1U, 2U, 10U, 64U}) {
    for (const std::size_t strands : {1U, 16U, 17U, 1000U}) {
      const StrandSkeleton skeleton = random_strands(strands, links, 0.5, strands);
      const StrandPose pose = random_bends(skeleton, 4.0, strands);
      EXPECT_EQ(bits_of(joints_of(skeleton, pose, GetParam()).data()),
                bits_of(joints_of(skeleton, pose, kBaseSimdRow).data()));
    }
  }
}

TEST_P(StrandKinematicsOnEachRow, PutsEachJointWhereTheFormulaSays) {
  for (const std::size_t links : {1U, 3U, 10U, 64U}) {
    const StrandSkeleton skeleton = random_strands(200, links, 3.0 / static_cast<double>(links), links);
    const StrandPose pose = random_bends(skeleton, 3.0, links);
    const JointPositions joints = joints_of(skeleton, pose, GetParam());
    for (std::size_t strand = 0; strand < 200; ++strand) {
      for (std::size_t link = 0; link < links; ++link) {
        const Vector expected = expected_joint(skeleton, pose, strand, link);
        const Vector found = vector_of(joints.joint(strand, link));
        for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(found[i], expected[i], 5e-6);
      }
    }
  }
}

TEST_P(StrandKinematicsOnEachRow, LinksKeepTheirLengthTo1e5OfIt) {
  for (const std::size_t links : {1U, 10U, 64U}) {
    for (const double curl_rad : {0.0, 0.05, 2.5}) {
      const StrandSkeleton skeleton = random_strands(1000, links, curl_rad, links);
      const StrandPose pose = random_bends(skeleton, std::numbers::pi, links);
      const JointPositions joints = joints_of(skeleton, pose, GetParam());
      const double length_m = 1.0 / static_cast<double>(links);
      for (std::size_t strand = 0; strand < 1000; ++strand) {
        Vector from = {};
        for (std::size_t link = 0; link < links; ++link) {
          const Vector to = vector_of(joints.joint(strand, link));
          EXPECT_NEAR(std::hypot(to[0] - from[0], to[1] - from[1], to[2] - from[2]), length_m, 1e-5 * length_m);
          from = to;
        }
      }
    }
  }
}

TEST(StrandKinematicsTest, AnUprightLinkFollowsThePapersFormula) {
  StrandSkeleton skeleton = random_strands(16, 1, 0.0, 1);
  skeleton.rest_x.assign(16, 0.0F);
  skeleton.rest_y.assign(16, 1.0F);
  skeleton.rest_z.assign(16, 0.0F);
  StrandPose pose = no_bend(skeleton);
  for (std::size_t i = 0; i < 16; ++i) {
    // Toward the azimuth phi, clockwise from north, by theta.
    const double phi = 0.4 * static_cast<double>(i);
    const double theta = 0.1 * static_cast<double>(i);
    pose.bend_east_rad[i] = static_cast<float>(theta * std::sin(phi));
    pose.bend_south_rad[i] = static_cast<float>(-theta * std::cos(phi));
  }
  const JointPositions joints = joints_of(skeleton, pose);
  for (std::size_t i = 0; i < 16; ++i) {
    const double phi = 0.4 * static_cast<double>(i);
    const double theta = 0.1 * static_cast<double>(i);
    EXPECT_NEAR(joints.joint(i, 0).x_m, std::sin(theta) * std::sin(phi), 1e-6);
    EXPECT_NEAR(joints.joint(i, 0).y_m, std::cos(theta), 1e-6);
    EXPECT_NEAR(joints.joint(i, 0).z_m, -std::sin(theta) * std::cos(phi), 1e-6);
  }
}

TEST(StrandKinematicsTest, ALyingLinkBendsUpAgainstAndDownWithTheWind) {
  // Hair that lies toward east: a wind from west presses it down, one from east lifts it.
  StrandSkeleton skeleton = random_strands(2, 1, 0.0, 1);
  skeleton.rest_x.assign(16, 1.0F);
  skeleton.rest_y.assign(16, 0.0F);
  skeleton.rest_z.assign(16, 0.0F);
  StrandPose pose = no_bend(skeleton);
  pose.bend_east_rad[0] = 0.3F;
  pose.bend_east_rad[1] = -0.3F;
  const JointPositions joints = joints_of(skeleton, pose);
  EXPECT_NEAR(joints.joint(0, 0).y_m, -std::sin(0.3), 1e-6);
  EXPECT_NEAR(joints.joint(1, 0).y_m, std::sin(0.3), 1e-6);
  EXPECT_NEAR(joints.joint(0, 0).x_m, std::cos(0.3), 1e-6);
}

TEST(StrandKinematicsTest, NoBendIsTheRestPoseBitForBit) {
  const StrandSkeleton skeleton = random_strands(100, 10, 0.1, 1);
  const StrandPose rest = no_bend(skeleton);
  const JointPositions at_rest = joints_of(skeleton, rest);
  for (const float nothing : {-0.0F, std::numeric_limits<float>::denorm_min(), 1e-30F}) {
    StrandPose pose = rest;
    pose.bend_east_rad.assign(skeleton.padded_count(), nothing);
    pose.bend_south_rad.assign(skeleton.padded_count(), -nothing);
    EXPECT_EQ(bits_of(joints_of(skeleton, pose).data()), bits_of(at_rest.data())) << nothing;
  }
  for (std::size_t strand = 0; strand < 100; ++strand) {
    const Vector expected = expected_joint(skeleton, rest, strand, 9);
    const Vector found = vector_of(at_rest.joint(strand, 9));
    for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(found[i], expected[i], 2e-6);
  }
}

TEST(StrandKinematicsTest, ASmallBendIsNearTheRestPose) {
  // Whatever its direction: the axis of a bend that vanishes must not matter.
  const StrandSkeleton skeleton = random_strands(256, 10, 0.1, 3);
  const JointPositions at_rest = joints_of(skeleton, no_bend(skeleton));
  for (const double bend_rad : {1e-3, 1e-6, 1e-12, 1e-19, 1e-21, 1e-38}) {
    const JointPositions bent = joints_of(skeleton, random_bends(skeleton, bend_rad, 4));
    for (std::size_t strand = 0; strand < 256; ++strand) {
      const Vector a = vector_of(at_rest.joint(strand, 9));
      const Vector b = vector_of(bent.joint(strand, 9));
      EXPECT_LE(std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]), bend_rad + 2e-6);
    }
  }
}

TEST(StrandKinematicsTest, EveryFiniteBendAndCurlHasFiniteJoints) {
  StrandSkeleton skeleton = random_strands(256, 10, 0.1, 3);
  StrandPose pose = no_bend(skeleton);
  const std::array extremes = {0.0F,  -0.0F,   1e-45F, 1e-38F, 1e-20F, 1.0F,  -3.2F, 32.0F,
                               50.0F, -100.0F, 1e6F,   1e10F,  -1e19F, 1e30F, 3e38F, -3e38F};
  for (std::size_t i = 0; i < 256; ++i) {
    pose.bend_east_rad[i] = extremes[i % 16];
    pose.bend_south_rad[i] = extremes[i / 16];
    skeleton.rest_curl_rad[i] = extremes[(i * 7) % 16];
  }
  const JointPositions joints = joints_of(skeleton, pose);
  for (const float coordinate : joints.data()) {
    ASSERT_TRUE(std::isfinite(coordinate));
    ASSERT_LE(std::abs(coordinate), 1.001F);
  }
}

TEST(StrandKinematicsTest, JointsStandInBlocksOf16Strands) {
  StrandSkeleton skeleton = random_strands(20, 3, 0.0, 1);
  for (std::size_t i = 0; i < skeleton.padded_count(); ++i) skeleton.root_x_m[i] = static_cast<float>(100 * i);
  const JointPositions joints = joints_of(skeleton, no_bend(skeleton));
  EXPECT_EQ(joints.data().size(), 2U * 3U * 3U * 16U);
  for (const std::size_t strand : {0U, 15U, 16U, 19U}) {
    for (std::size_t link = 0; link < 3; ++link) {
      const JointPosition joint = joints.joint(strand, link);
      const std::size_t at = ((strand / 16 * 3 + link) * 3) * 16 + strand % 16;
      EXPECT_EQ(joint.x_m, joints.data()[at]);
      EXPECT_EQ(joint.y_m, joints.data()[at + 16]);
      EXPECT_EQ(joint.z_m, joints.data()[at + 32]);
      EXPECT_NEAR(joint.x_m, 100.0F * static_cast<float>(strand), 1.1F);
    }
  }
}

TEST(StrandKinematicsTest, SaysWhatIsWrongAndThenDoesNothing) {
  const StrandSkeleton skeleton = random_strands(20, 3, 0.0, 1);
  const StrandPose pose = no_bend(skeleton);
  JointPositions joints(skeleton);
  const StrandKinematicsJob good{.skeleton = &skeleton, .pose = &pose, .joints = &joints};
  EXPECT_EQ(good.validate(), Problem::kNone);

  for (int missing = 0; missing < 3; ++missing) {
    StrandKinematicsJob job = good;
    if (missing == 0) job.skeleton = nullptr;
    if (missing == 1) job.pose = nullptr;
    if (missing == 2) job.joints = nullptr;
    EXPECT_EQ(job.run(), Problem::kMissingPart);
  }
  StrandKinematicsJob job = good;
  StrandSkeleton short_skeleton = skeleton;
  short_skeleton.curl_z.pop_back();
  job.skeleton = &short_skeleton;
  EXPECT_EQ(job.run(), Problem::kSkeletonSize);
  StrandSkeleton no_links = skeleton;
  no_links.links_per_strand = 0;
  job.skeleton = &no_links;
  EXPECT_EQ(job.run(), Problem::kSkeletonSize);
  job = good;
  const StrandPose short_pose{std::vector<float>(32), std::vector<float>(20)};
  job.pose = &short_pose;
  EXPECT_EQ(job.run(), Problem::kPoseSize);
  job = good;
  JointPositions other(random_strands(20, 4, 0.0, 1));
  job.joints = &other;
  EXPECT_EQ(job.run(), Problem::kJointsSize);
  for (const float coordinate : other.data()) EXPECT_EQ(coordinate, 0.0F);
}

}  // namespace
}  // namespace yuragi::pose
