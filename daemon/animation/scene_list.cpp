#include "daemon/animation/scene_list.hpp"

#include <algorithm>

#include <fmt/core.h>

#include "engine/pose/pose_arrays.hpp"

namespace yuragi::daemon::animation {
namespace {

// A frame may grow by a few bytes when a field differs from its default; the buffers have room for that.
constexpr std::size_t kFrameSlack_bytes = 256;

}  // namespace

std::shared_ptr<StagedScene> make_staged_scene(const settings::Config& config, std::size_t index,
                                               const std::shared_ptr<const wind::turbulence::GustNoise>& gusts) {
  const settings::SceneConfig& scene = config.scenes[index];
  auto staged = std::make_shared<StagedScene>();
  staged->scene =
      scene.kind->make(scene.values, {.seed = config.seed + index, .placement = scene.placement, .gusts = gusts});
  staged->wind_gain = scene.wind_gain;
  return staged;
}

SceneList::SceneList(std::shared_ptr<const SceneRoster> roster, std::span<const Entry> leaving,
                     std::uint64_t generation)
    : roster_(std::move(roster)), generation_(generation) {
  for (std::size_t i = 0; i < roster_->scenes.size(); ++i) {
    const settings::SceneConfig& config = roster_->configs[i];
    entries_.push_back({config.name, std::string(config.kind->name), roster_->scenes[i], config.cloth});
  }
  entries_.insert(entries_.end(), leaving.begin(), leaving.end());

  // A frame of rest poses makes the encoder allocate its largest buffer. The scenes' own poses may be moving now.
  std::vector<pose::Pose> rest;
  for (const Entry& entry : entries_) {
    const scenes::Scene& scene = *entry.staged->scene;
    skeletons_.push_back(&scene.skeleton());
    poses_.push_back(&scene.pose());
    rest.push_back(pose::rest_pose(scene.skeleton()));
  }
  opacities_.resize(entries_.size());
  if (roster_->settles) settling_.emplace(skeletons_);
  std::vector<const pose::Pose*> rest_poses;
  rest_poses.reserve(rest.size());
  for (const pose::Pose& pose : rest) rest_poses.push_back(&pose);
  largest_frame_bytes_ = encoder_.encode({}, skeletons_, rest_poses).size();
  for (wire::Bytes& room : rooms_) room.resize(largest_frame_bytes_ + kFrameSlack_bytes);
}

void SceneList::make_room_in(wire::Bytes& buffer) noexcept {
  const std::size_t needed = largest_frame_bytes_ + kFrameSlack_bytes;
  if (buffer.capacity() >= needed) return;
  const auto room =
      std::find_if(rooms_.begin(), rooms_.end(), [&](const wire::Bytes& it) { return it.capacity() >= needed; });
  if (room != rooms_.end()) buffer.swap(*room);
}

wire::Scenes SceneList::describe() const {
  wire::Scenes all;
  for (const Entry& entry : entries_) {
    all.scenes.push_back({entry.name, entry.kind, entry.staged->scene->skeleton(), entry.cloth});
  }
  return all;
}

std::optional<wire::Bytes> scenes_message(const wire::Scenes& scenes) {
  wire::Bytes message = wire::encode(scenes);
  if (!wire::decode(std::span(message).subspan(wire::kSizePrefixBytes))) return std::nullopt;
  return message;
}

wire::Bytes checked_scenes_message(const wire::Scenes& scenes) {
  if (auto message = scenes_message(scenes)) return std::move(*message);
  throw settings::ConfigError(
      fmt::format("[[scene]]: the scenes are larger than the stream allows; allowed in total: {} scenes, {} strands, "
                  "joints of cloth and points of surfaces, and {} pixels of pictures",
                  wire::kMaxScenes, wire::kMaxStrands, wire::kMaxPixels));
}

}  // namespace yuragi::daemon::animation
