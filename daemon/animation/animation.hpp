#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "daemon/animation/scene_change.hpp"
#include "daemon/animation/scene_list.hpp"
#include "daemon/settings/config.hpp"
#include "engine/pose/reach.hpp"
#include "engine/wind/view_wind.hpp"
#include "engine/wind/wind_state.hpp"
#include "engine/wire/wire.hpp"
#include "engine/workers/sharing_choice.hpp"
#include "engine/workers/worker_pool.hpp"

namespace yuragi::daemon::animation {

/// An order to show or hide a scene.
struct SceneCue {
  std::size_t scene = 0;  ///< its index, in the order of the configuration
  bool shown = true;
  bool hide_others = false;  ///< hide every other scene in the same time
  double over_s = 0.0;       ///< duration of the fade, at least 0
};

/// All scenes of an installation, each at its place and with its gain on the wind, stepped together, and the encoder of
/// their frames. A hidden scene is not stepped. The scenes may be exchanged for others between two steps. It follows no
/// clock: the daemon's loop, the lock-step replay and the tests step it. How long each scene takes is measured
/// (StagedScene::step_time), and decides only whether threads share the next steps.
///
/// Thread-safe: no. What is noexcept, and encode(), are realtime-safe; with [animation] threads above 1 a step
/// waits for the pool's threads (workers::Pool), if that takes less time (SharingChoice). Poses do not depend on the
/// number of threads.
class Animation {
 public:
  /// `gusts`: of the wind that step() will be given. Of a configuration that leads or follows it has tapes for as many
  /// places as a leader may have.
  Animation(const settings::Config& config, const std::shared_ptr<const wind::turbulence::GustNoise>& gusts);

  /// Writes the wind onto the tapes, and advances every visible scene and every fade by dt_s. `ticks`: how many have
  /// passed since the last step, more than 1 if some were skipped.
  void step(const wind::ground::DrivingWind& wind, double dt_s, std::uint64_t ticks = 1) noexcept;

  /// Begins a fade. Ignored for a scene that does not exist. While a change is carried out, scenes are counted as after
  /// it.
  void cue(const SceneCue& cue) noexcept;

  /// Of all scenes and of the wind over the ground, for a snapshot (engine/base/snapshot.hpp). Not while a change is
  /// carried out (is_changing()). Not realtime-safe.
  void list_state(StatePass& pass);
  bool is_changing() const noexcept { return change_ != nullptr; }

  /// Saves that state: appends to `state`, and allocates nothing if that has room. `now`: the moment of the last step's
  /// wind. False while a change is carried out.
  bool save_state(std::vector<std::uint8_t>& state, MonoTime now);
  /// Loads it between two steps; what is shown does not jump, if the animation settles(). False, and nothing changes,
  /// while a change is carried out or if the bytes are not of these scenes. Allocates nothing.
  bool load_state(std::span<const std::uint8_t> state, MonoTime now);

  /// Begins to exchange the scenes, of which the change was made. Not while another change is carried out.
  void begin_change(std::unique_ptr<SceneChange> change) noexcept;
  /// Returns the completed change, with the objects to free; null if there is none.
  std::unique_ptr<SceneChange> take_finished_change() noexcept;

  /// The frame of the present poses, size prefix included; valid until the next call.
  std::span<const std::uint8_t> encode(const wire::FrameInfo& info) {
    wire::FrameInfo with_view = info;
    with_view.view_wind_from_deg = view_wind_from_deg();
    return scenes_->encode(with_view);
  }
  /// Where the wind comes from for cameras that keep their angle to it.
  double view_wind_from_deg() const noexcept { return view_wind_.from_deg(); }
  /// The number of the list of scenes that the frame is of.
  std::uint64_t generation() const noexcept { return scenes_->generation(); }
  /// Ensures that `buffer` has room for any frame of the present scenes.
  void make_room_in(wire::Bytes& buffer) noexcept { scenes_->make_room_in(buffer); }

  /// The size of a frame in which every scene is visible, which is the largest.
  std::size_t largest_frame_bytes() const noexcept { return scenes_->largest_frame_bytes(); }

  /// The skeletons, for clients that join.
  wire::Scenes describe() const { return scenes_->describe(); }
  /// The base for the next change.
  const std::shared_ptr<const SceneRoster>& roster() const noexcept { return scenes_->roster(); }

  std::span<const pose::Skeleton* const> skeletons() const noexcept { return scenes_->skeletons(); }
  std::span<const pose::Pose* const> poses() const noexcept { return scenes_->poses(); }
  std::span<const float> opacities() const noexcept { return scenes_->opacities(); }
  std::size_t node_count() const;
  /// From the middle of the scenes to the farthest place of any of them, hidden or not.
  double reach_m() const noexcept { return pose::scenes_reach_m(skeletons()); }

 private:
  void finish_change() noexcept;

  std::unique_ptr<SceneList> scenes_;
  std::unique_ptr<SceneChange> change_;  // that is being carried out, or over and not yet taken
  workers::Pool pool_;
  workers::SharingChoice sharing_;
  wind::ground::WindTapes tapes_;
  wind::ViewWind view_wind_;
  std::uint64_t tick_ = 0;  // the number of the last one
};

}  // namespace yuragi::daemon::animation
