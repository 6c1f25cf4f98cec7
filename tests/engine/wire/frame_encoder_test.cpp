#include <cstdlib>
#include <new>

#include <gtest/gtest.h>

#include "engine/wire/wire.hpp"
#include "tests/engine/wire/samples.hpp"

namespace {
std::size_t allocations = 0;
}

// Counted here, for the whole of this program. Not inlined: GCC would take free() for a mistake.
[[gnu::noinline]] void* operator new(std::size_t size) {
  ++allocations;
  if (void* memory = std::malloc(size)) return memory;
  throw std::bad_alloc();
}
[[gnu::noinline]] void operator delete(void* memory) noexcept {
  std::free(memory);
}
[[gnu::noinline]] void operator delete(void* memory, std::size_t) noexcept {
  std::free(memory);
}

namespace yuragi::wire {
namespace {

/// A set of scenes, what they need to be encoded, and an encoder.
class FrameEncoderTest : public testing::Test {
 protected:
  static constexpr std::size_t kStrands = 10'000;  // of ten links: 100,000 nodes

  std::span<const std::uint8_t> encode(const FrameInfo& info) { return encoder_.encode(info, skeletons_, poses_); }

  static Frame decoded(std::span<const std::uint8_t> bytes) {
    return std::get<Frame>(decode(bytes.subspan(kSizePrefixBytes)).value());
  }

  pose::Skeleton grass_ = samples::meadow(kStrands);
  pose::Skeleton fringe_ = samples::meadow(3, 1);
  pose::Pose grass_pose_ = samples::bent(kStrands);
  pose::Pose fringe_pose_ = samples::bent(3);
  std::vector<const pose::Skeleton*> skeletons_{&grass_, &fringe_};
  std::vector<const pose::Pose*> poses_{&grass_pose_, &fringe_pose_};
  FrameEncoder encoder_;
};

TEST_F(FrameEncoderTest, AHundredThousandNodesAtSixtyHertzAreWithinHundredMegabitASecond) {
  const std::size_t bytes = encode(samples::frame_info()).size();
  EXPECT_LE(bytes * 60 * 8, 100'000'000u);
  EXPECT_LE(bytes, 4 * kStrands + 512) << "two 16-bit numbers a strand, and little else";
}

TEST_F(FrameEncoderTest, NothingIsAllocatedAfterTheFirstFrame) {
  encode(FrameInfo{});
  const std::size_t before = allocations;
  for (std::uint64_t i = 0; i < 100; ++i) {
    FrameInfo info = samples::frame_info();
    info.sequence = ~i;
    std::get<pose::StrandPose>(grass_pose_).bend_east_rad[i] = 0.5f;
    ASSERT_GT(encode(info).size(), 4 * kStrands);
  }
  EXPECT_EQ(allocations, before);
}

TEST_F(FrameEncoderTest, AllFramesOfASetOfScenesHaveOneSize) {
  const std::size_t first = encode(FrameInfo{}).size();
  EXPECT_EQ(encode(samples::frame_info()).size(), first);
}

TEST(FrameEncoderOfAllKinds, AllocatesNothingWhateverIsShownAndHiddenAfterAFrameThatShowsAll) {
  const Scenes scenes = samples::all_kinds();
  const std::vector<pose::Pose> moved = samples::all_moved();
  std::vector<const pose::Skeleton*> skeletons;
  std::vector<const pose::Pose*> poses;
  for (std::size_t i = 0; i < moved.size(); ++i) {
    skeletons.push_back(&scenes.scenes[i].skeleton);
    poses.push_back(&moved[i]);
  }
  std::vector<float> opacities(moved.size(), 1.0f);
  FrameEncoder encoder;
  const std::size_t largest = encoder.encode(FrameInfo{}, skeletons, poses, opacities).size();
  const std::size_t before = allocations;
  for (unsigned round = 0; round < 64; ++round) {
    for (unsigned i = 0; i < opacities.size(); ++i) opacities[i] = (round >> i) % 2 == 0 ? 0.0f : 0.5f;
    ASSERT_LE(encoder.encode(samples::frame_info(), skeletons, poses, opacities).size(), largest);
  }
  EXPECT_EQ(allocations, before);
}

TEST_F(FrameEncoderTest, LaterFramesCarryLaterPoses) {
  encode(FrameInfo{});
  auto& pose = std::get<pose::StrandPose>(grass_pose_);
  pose.bend_east_rad[0] = -1.25f;
  pose.bend_south_rad[kStrands - 1] = 0.75f;
  const Frame frame = decoded(encode(samples::frame_info()));
  const auto& got = std::get<pose::StrandPose>(frame.poses[0]);
  EXPECT_NEAR(got.bend_east_rad[0], -1.25f, 5e-5f);
  EXPECT_NEAR(got.bend_south_rad[kStrands - 1], 0.75f, 5e-5f);
}

TEST_F(FrameEncoderTest, BendsBeyondHalfATurnSaturate) {
  std::get<pose::StrandPose>(fringe_pose_).bend_east_rad[0] = 10.0f;
  std::get<pose::StrandPose>(fringe_pose_).bend_east_rad[1] = -10.0f;
  const Frame frame = decoded(encode(samples::frame_info()));
  const auto& got = std::get<pose::StrandPose>(frame.poses[1]);
  EXPECT_NEAR(got.bend_east_rad[0], 3.14159265f, 1e-6f);
  EXPECT_NEAR(got.bend_east_rad[1], -3.14159265f, 1e-6f);
}

TEST_F(FrameEncoderTest, TheSetOfScenesMayChange) {
  encode(samples::frame_info());
  const std::vector<const pose::Skeleton*> one_skeleton{&fringe_};
  const std::vector<const pose::Pose*> one_pose{&fringe_pose_};
  EXPECT_EQ(decoded(encoder_.encode(samples::frame_info(), one_skeleton, one_pose)).poses.size(), 1u);
  EXPECT_EQ(decoded(encoder_.encode(samples::frame_info(), {}, {})).poses.size(), 0u);
  EXPECT_EQ(decoded(encode(samples::frame_info())).poses.size(), 2u);
}

TEST_F(FrameEncoderTest, AnEncoderCanBeMoved) {
  encode(samples::frame_info());
  FrameEncoder other = std::move(encoder_);
  EXPECT_EQ(decoded(other.encode(samples::frame_info(), skeletons_, poses_)).poses.size(), 2u);
}

}  // namespace
}  // namespace yuragi::wire
