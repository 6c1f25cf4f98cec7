#pragma once

#include <memory>
#include <span>
#include <vector>

#include "daemon/animation/fade.hpp"
#include "daemon/settings/config.hpp"
#include "engine/pose/reach.hpp"
#include "engine/scenes/scene.hpp"
#include "engine/wind/wind_state.hpp"
#include "engine/wire/wire.hpp"
#include "engine/workers/worker_pool.hpp"

namespace yuragi {

/// A change of what is shown.
struct SceneCue {
  std::size_t scene = 0;  ///< its number, in the order of the configuration
  bool shown = true;
  bool hide_others = false;  ///< and every other scene is hidden in the same time
  double over_s = 0.0;       ///< at least 0
};

/// The scenes of an installation, each where it stands and with its gain on the wind, stepped together, and the frame
/// that shows them. A scene that is hidden stands still and costs nothing. No clock: the daemon's loop, the lock-step
/// replay and the tests all step this one.
///
/// Thread-safe: no. step(), cue() and encode() are realtime-safe; with [animation] threads above 1 a step waits for the
/// pool's threads (WorkerPool). Poses do not depend on how many there are.
class Animation {
 public:
  /// `gusts`: of the wind that step() will be given.
  Animation(const Config& config, const std::shared_ptr<const GustNoise>& gusts);

  /// Writes the wind onto the tapes that carry it over the ground, and moves every scene that is seen, and every fade,
  /// on by dt_s under it.
  void step(const DrivingWind& wind, double dt_s) noexcept;

  /// Begins a fade. A scene that is not there is no scene to show: nothing happens.
  void cue(const SceneCue& cue) noexcept;

  /// The frame of the present poses, size prefix included; valid until the next call.
  std::span<const std::uint8_t> encode(const wire::FrameInfo& info) {
    return encoder_.encode(info, skeletons_, poses_, opacities_);
  }

  /// The size of a frame in which every scene is seen: none is larger.
  std::size_t largest_frame_bytes() const noexcept { return largest_frame_bytes_; }

  /// The skeletons, for clients that join.
  wire::Scenes describe() const;

  std::span<const Skeleton* const> skeletons() const noexcept { return skeletons_; }
  std::span<const Pose* const> poses() const noexcept { return poses_; }
  std::span<const float> opacities() const noexcept { return opacities_; }
  std::size_t node_count() const;
  /// From the middle of the scenes to the farthest place of any of them, hidden or not.
  double reach_m() const noexcept { return scenes_reach_m(skeletons_); }

 private:
  std::vector<std::string> names_, kinds_;
  std::vector<std::unique_ptr<Scene>> scenes_;
  WorkerPool pool_;
  WindTapes tapes_;
  std::vector<double> gains_;
  std::vector<Fade> fades_;
  std::vector<const Skeleton*> skeletons_;
  std::vector<const Pose*> poses_;
  std::vector<float> opacities_;
  wire::FrameEncoder encoder_;
  std::size_t largest_frame_bytes_ = 0;
};

}  // namespace yuragi
