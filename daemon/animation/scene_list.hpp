#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "daemon/animation/fade.hpp"
#include "daemon/animation/running_mean.hpp"
#include "daemon/animation/settling_poses.hpp"
#include "daemon/settings/config.hpp"
#include "engine/scenes/scene.hpp"
#include "engine/wire/wire.hpp"

namespace yuragi::daemon::animation {

/// A scene, its opacity, and its gain on the wind. The lists that hold a scene share it; only the thread that steps the
/// animation reads or changes more of it than the skeleton, but `step_time`, which others may read.
struct StagedScene {
  std::unique_ptr<scenes::Scene> scene;
  Fade fade{false};
  double wind_gain = 1.0;
  RunningMean step_time;  ///< of its part of a tick; 0 while it is hidden

  void list_state(StatePass& pass) { pass(fade, *scene); }
};

/// The scenes of a configuration, and what they were made from. Never changes, so that several threads may share it.
struct SceneRoster {
  std::uint64_t generation = 0;  ///< of the list of these scenes
  std::uint64_t seed = 0;
  bool settles = false;  ///< its lists have memory to hide that another state is loaded (SettlingPoses)
  std::shared_ptr<const wind::turbulence::GustNoise> gusts;
  std::vector<settings::SceneConfig> configs;
  std::vector<std::shared_ptr<StagedScene>> scenes;  ///< one for each of configs
};

/// Makes the scene at `index` of the configuration, hidden, in its rest pose.
std::shared_ptr<StagedScene> make_staged_scene(const settings::Config& config, std::size_t index,
                                               const std::shared_ptr<const wind::turbulence::GustNoise>& gusts);

/// The scenes that are stepped and streamed together, in the order of the stream's Scenes message, with all memory that
/// a tick needs for them: first those of a roster, then those that leave, which it has had before.
///
/// Thread-safe: no. Once made, it allocates nothing.
class SceneList {
 public:
  struct Entry {
    std::string name, kind;
    std::shared_ptr<StagedScene> staged;
    look::ClothLook cloth = {};
  };

  SceneList(std::shared_ptr<const SceneRoster> roster, std::span<const Entry> leaving, std::uint64_t generation);

  /// Numbers the lists of an animation: clients need its Scenes message before a frame of it.
  std::uint64_t generation() const noexcept { return generation_; }
  const std::shared_ptr<const SceneRoster>& roster() const noexcept { return roster_; }

  std::size_t size() const noexcept { return entries_.size(); }
  StagedScene& operator[](std::size_t index) noexcept { return *entries_[index].staged; }

  std::span<const pose::Skeleton* const> skeletons() const noexcept { return skeletons_; }
  std::span<const pose::Pose* const> poses() const noexcept { return poses_; }
  std::span<const float> opacities() const noexcept { return opacities_; }

  /// Takes over how visible each scene is now.
  void read_opacities() noexcept {
    for (std::size_t i = 0; i < entries_.size(); ++i) opacities_[i] = entries_[i].staged->fade.opacity();
  }

  /// Call it before another state of the scenes is loaded: what is shown does not jump.
  void keep_shown() noexcept {
    if (settling_) settling_->keep(poses_, opacities_);
  }
  /// Call it after each step.
  void settle(double dt_s) noexcept {
    if (settling_) settling_->advance(poses_, opacities_, dt_s);
  }

  /// The frame of the present poses, size prefix included; valid until the next call.
  std::span<const std::uint8_t> encode(const wire::FrameInfo& info) {
    if (!settling_ || !settling_->is_settling()) return encoder_.encode(info, skeletons_, poses_, opacities_);
    settling_->show(poses_, opacities_);
    return encoder_.encode(info, skeletons_, settling_->poses(), settling_->opacities());
  }
  /// The size of a frame in which every scene is visible, which is the largest.
  std::size_t largest_frame_bytes() const noexcept { return largest_frame_bytes_; }
  /// Ensures that `buffer` has room for any frame of this list, by exchanging it for one that was made with the
  /// list. There are as many of these as a triple buffer has places.
  void make_room_in(wire::Bytes& buffer) noexcept;

  /// The skeletons, for clients.
  wire::Scenes describe() const;

 private:
  std::shared_ptr<const SceneRoster> roster_;
  std::uint64_t generation_;
  std::vector<Entry> entries_;
  std::vector<const pose::Skeleton*> skeletons_;
  std::vector<const pose::Pose*> poses_;
  std::vector<float> opacities_;
  std::optional<SettlingPoses> settling_;
  wire::FrameEncoder encoder_;
  std::size_t largest_frame_bytes_ = 0;
  std::array<wire::Bytes, 3> rooms_;
};

/// Returns the Scenes message; nullopt if the scenes exceed the limits of the stream, so that clients would refuse it.
std::optional<wire::Bytes> scenes_message(const wire::Scenes& scenes);
/// The same; throws settings::ConfigError, which names what is allowed.
wire::Bytes checked_scenes_message(const wire::Scenes& scenes);

}  // namespace yuragi::daemon::animation
