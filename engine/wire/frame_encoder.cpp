#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <cstdint>
#include <limits>

#include "engine/pose/pose_arrays.hpp"
#include "engine/pose/quantise.hpp"
#include "engine/wire/schema.hpp"
#include "engine/wire/wire.hpp"

namespace yuragi::wire {

// The quantised numbers are written directly into the buffer, which FlatBuffers defines as little-endian.
static_assert(std::endian::native == std::endian::little);

struct FrameEncoder::Builder {
  flatbuffers::FlatBufferBuilder buffer;  // keeps its memory from frame to frame
  std::vector<flatbuffers::Offset<fb::ScenePose>> scenes;

  using Units = flatbuffers::Offset<flatbuffers::Vector<std::int16_t>>;

  Units add_bends(std::span<const float> bend_rad) {
    std::int16_t* values = nullptr;
    const auto vector = buffer.CreateUninitializedVector(bend_rad.size(), &values);
    pose::quantise(bend_rad, {values, bend_rad.size()});
    return vector;
  }

  /// `rows` runs of `columns` values, which are `stride` apart.
  Units add_ways(std::span<const float> way_m, float step_m, std::size_t columns, std::size_t rows,
                 std::size_t stride) {
    std::int16_t* values = nullptr;
    const auto vector = buffer.CreateUninitializedVector(columns * rows, &values);
    for (std::size_t row = 0; row < rows; ++row)
      pose::quantise_ways(way_m.subspan(row * stride, columns), step_m, {values + row * columns, columns});
    return vector;
  }

  flatbuffers::Offset<fb::StrandPose> add(const pose::StrandPose& pose, const pose::StrandSkeleton& skeleton) {
    const auto east = add_bends({pose.bend_east_rad.data(), skeleton.strand_count});
    const auto south = add_bends({pose.bend_south_rad.data(), skeleton.strand_count});
    return fb::CreateStrandPose(buffer, pose::kBendStep_rad, east, south);
  }

  flatbuffers::Offset<fb::GridPose> add(const pose::GridPose& pose, const pose::GridSkeleton& grid) {
    const float step_m = pose::way_step_m(grid);
    const auto add_axis = [&](const std::vector<float>& offset_m) {
      return add_ways(offset_m, step_m, grid.columns, grid.rows, grid.stride());
    };
    const auto x = add_axis(pose.offset_x_m);
    const auto y = add_axis(pose.offset_y_m);
    const auto z = add_axis(pose.offset_z_m);
    return fb::CreateGridPose(buffer, static_cast<std::uint32_t>(grid.columns), step_m, x, y, z);
  }

  flatbuffers::Offset<fb::TreePose> add(const pose::TreePose& pose, const pose::TreeSkeleton& tree) {
    std::array<flatbuffers::Offset<fb::StrandPose>, pose::kMaxTreeLevels> levels;
    const std::size_t count = std::min(tree.levels.size(), levels.size());
    for (std::size_t i = 0; i < count; ++i) levels[i] = add(pose.levels[i], tree.levels[i].strands);
    return fb::CreateTreePose(buffer, buffer.CreateVector(levels.data(), count));
  }

  flatbuffers::Offset<fb::SurfacePose> add(const pose::SurfacePose& pose, const pose::SurfaceSkeleton& surface) {
    const float step_m = pose::way_step_m(surface);
    const std::size_t count = surface.columns * surface.rows;
    const auto displacement = add_ways(pose.displacement_m, step_m, count, 1, count);
    std::uint8_t* heat = nullptr;
    const auto colours = buffer.CreateUninitializedVector(pose.heat.size(), &heat);
    pose::quantise_heat(pose.heat, {heat, pose.heat.size()});
    if (!surface.moves_rows()) return fb::CreateSurfacePose(buffer, step_m, displacement, colours);
    const auto add_rows = [&](const std::vector<float>& values, float step) {
      return add_ways(values, step, surface.rows, 1, surface.rows);
    };
    const auto east = add_rows(pose.row_east_m, step_m);
    const auto south = add_rows(pose.row_south_m, step_m);
    const auto drop = add_rows(pose.row_drop_m, step_m);
    const auto slope_east = add_rows(pose.row_slope_east, pose::kSlopeStep);
    const auto slope_south = add_rows(pose.row_slope_south, pose::kSlopeStep);
    return fb::CreateSurfacePose(buffer, step_m, displacement, colours, east, south, drop, pose::kSlopeStep, slope_east,
                                 slope_south);
  }

  flatbuffers::Offset<fb::ScenePose> add_scene(const pose::Pose& pose, const pose::Skeleton& skeleton, float opacity) {
    if (!(opacity > 0.0F)) return fb::CreateScenePose(buffer, fb::Pose_NONE, 0, 0.0F);
    assert(fits(pose, skeleton));
    const auto kind = static_cast<fb::Pose>(pose.index() + fb::Pose_MIN + 1);
    const auto add_kind = [&](const auto* model, const auto* moved) {
      return model == nullptr ? flatbuffers::Offset<void>() : add(*moved, *model).Union();
    };
    flatbuffers::Offset<void> body;
    switch (kind) {
      case fb::Pose_StrandPose:
        body = add_kind(std::get_if<pose::StrandSkeleton>(&skeleton), std::get_if<pose::StrandPose>(&pose));
        break;
      case fb::Pose_GridPose:
        body = add_kind(std::get_if<pose::GridSkeleton>(&skeleton), std::get_if<pose::GridPose>(&pose));
        break;
      case fb::Pose_TreePose:
        body = add_kind(std::get_if<pose::TreeSkeleton>(&skeleton), std::get_if<pose::TreePose>(&pose));
        break;
      case fb::Pose_SurfacePose:
        body = add_kind(std::get_if<pose::SurfaceSkeleton>(&skeleton), std::get_if<pose::SurfacePose>(&pose));
        break;
      case fb::Pose_NONE:
        break;
    }
    return fb::CreateScenePose(buffer, kind, body, std::min(opacity, 1.0F));
  }
};
static_assert(fb::Pose_MAX == std::variant_size_v<pose::Pose>, "the kinds of skeleton.hpp, in the same order");

FrameEncoder::FrameEncoder() : builder_(std::make_unique<Builder>()) {
  // A zero takes as much space as any other number, so that no later frame is longer than the first.
  builder_->buffer.ForceDefaults(true);
}

FrameEncoder::~FrameEncoder() = default;
FrameEncoder::FrameEncoder(FrameEncoder&&) noexcept = default;
FrameEncoder& FrameEncoder::operator=(FrameEncoder&&) noexcept = default;

std::span<const std::uint8_t> FrameEncoder::encode(const FrameInfo& info,
                                                   std::span<const pose::Skeleton* const> skeletons,
                                                   std::span<const pose::Pose* const> poses,
                                                   std::span<const float> opacities) {
  assert(skeletons.size() == poses.size() && (opacities.empty() || opacities.size() == poses.size()));
  auto& buffer = builder_->buffer;
  buffer.Clear();

  auto& scenes = builder_->scenes;
  scenes.clear();
  for (std::size_t i = 0; i < skeletons.size(); ++i)
    scenes.push_back(builder_->add_scene(*poses[i], *skeletons[i], opacities.empty() ? 1.0F : opacities[i]));
  const auto scene_vector = buffer.CreateVector(scenes);

  const fb::Wind wind = to_schema(info.wind);
  const fb::WindPlace place = place_to_schema(info.wind);
  // Not a number if there is none: frames of the same scenes have one size, so that none allocates.
  const double view_wind_from_deg = info.view_wind_from_deg.value_or(std::numeric_limits<double>::quiet_NaN());
  const auto frame = fb::CreateFrame(buffer, info.sequence, info.tick, info.time_s, info.utc_ns, &wind, scene_vector,
                                     &place, view_wind_from_deg);
  fb::FinishSizePrefixedMessageBuffer(buffer, fb::CreateMessage(buffer, fb::Body_Frame, frame.Union()));
  return {buffer.GetBufferPointer(), buffer.GetSize()};
}

}  // namespace yuragi::wire
