#include <bit>
#include <cassert>
#include <cstdint>

#include "engine/pose/quantise.hpp"
#include "engine/wire/schema.hpp"
#include "engine/wire/wire.hpp"

namespace yuragi::wire {

// The quantised numbers go straight into the buffer, which FlatBuffers defines as little-endian.
static_assert(std::endian::native == std::endian::little);

struct FrameEncoder::Builder {
  flatbuffers::FlatBufferBuilder buffer;  // keeps its memory from frame to frame
  std::vector<flatbuffers::Offset<fb::ScenePose>> scenes;

  flatbuffers::Offset<flatbuffers::Vector<std::int16_t>> add_quantised(std::span<const float> bend_rad) {
    std::int16_t* values = nullptr;
    const auto vector = buffer.CreateUninitializedVector(bend_rad.size(), &values);
    quantise(bend_rad, {values, bend_rad.size()});
    return vector;
  }

  flatbuffers::Offset<fb::ScenePose> add_pose(const StrandPose& pose, const StrandSkeleton& skeleton) {
    assert(pose.bend_east_rad.size() >= skeleton.strand_count && pose.bend_south_rad.size() >= skeleton.strand_count);
    const auto east = add_quantised({pose.bend_east_rad.data(), skeleton.strand_count});
    const auto south = add_quantised({pose.bend_south_rad.data(), skeleton.strand_count});
    const auto strands = fb::CreateStrandPose(buffer, kBendStep_rad, east, south);
    return fb::CreateScenePose(buffer, fb::Pose_StrandPose, strands.Union());
  }
};

FrameEncoder::FrameEncoder() : builder_(std::make_unique<Builder>()) {
  // A zero takes as much room as any other number, so that no later frame is longer than the first.
  builder_->buffer.ForceDefaults(true);
}

FrameEncoder::~FrameEncoder() = default;
FrameEncoder::FrameEncoder(FrameEncoder&&) noexcept = default;
FrameEncoder& FrameEncoder::operator=(FrameEncoder&&) noexcept = default;

std::span<const std::uint8_t> FrameEncoder::encode(const FrameInfo& info, std::span<const Skeleton* const> skeletons,
                                                   std::span<const Pose* const> poses) {
  assert(skeletons.size() == poses.size());
  auto& buffer = builder_->buffer;
  buffer.Clear();

  // Scene by scene; the poses of a strand skeleton are the only kind yet.
  auto& scenes = builder_->scenes;
  scenes.clear();
  for (std::size_t i = 0; i < skeletons.size(); ++i)
    scenes.push_back(builder_->add_pose(std::get<StrandPose>(*poses[i]), std::get<StrandSkeleton>(*skeletons[i])));
  const auto scene_vector = buffer.CreateVector(scenes);

  const fb::Wind wind = to_schema(info.wind);
  const auto frame = fb::CreateFrame(buffer, info.sequence, info.tick, info.time_s, info.utc_ns, &wind, scene_vector);
  fb::FinishSizePrefixedMessageBuffer(buffer, fb::CreateMessage(buffer, fb::Body_Frame, frame.Union()));
  return {buffer.GetBufferPointer(), buffer.GetSize()};
}

}  // namespace yuragi::wire
