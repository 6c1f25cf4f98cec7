#include "engine/pose/pose_hash.hpp"

#include <vector>

#include <gtest/gtest.h>

namespace yuragi::pose {
namespace {

TEST(PoseHashTest, IsFnv1aOfTheBytes) {
  const std::vector<float> abcd = {std::bit_cast<float>(0x64636261U)};
  EXPECT_EQ(pose_hash(kPoseHashSeed, abcd), 0xfc179f83ee0724ddU);
  EXPECT_EQ(pose_hash(kPoseHashSeed, std::vector<float>{}), kPoseHashSeed);
}

TEST(PoseHashTest, GoesOnWhereItLeftOff) {
  const std::vector<float> all = {1.0F, 2.0F, 3.0F};
  const std::span<const float> values = all;
  EXPECT_EQ(pose_hash(pose_hash(kPoseHashSeed, values.first(1)), values.subspan(1)), pose_hash(kPoseHashSeed, all));
}

TEST(PoseHashTest, SeesEachBit) {
  EXPECT_NE(pose_hash(kPoseHashSeed, std::vector{0.0F}), pose_hash(kPoseHashSeed, std::vector{-0.0F}));
  EXPECT_NE(pose_hash(kPoseHashSeed, std::vector{1.0F}), pose_hash(kPoseHashSeed, std::vector{1.0F + 1.2e-7F}));
}

TEST(PoseHashTest, OfAPoseTakesBothOfItsParts) {
  const StrandPose pose{{1.0F}, {2.0F}};
  EXPECT_EQ(pose_hash(kPoseHashSeed, pose), pose_hash(kPoseHashSeed, std::vector{1.0F, 2.0F}));
}

}  // namespace
}  // namespace yuragi::pose
