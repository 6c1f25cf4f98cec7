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

namespace yuragi::daemon::animation {

/// An order to show or hide a scene.
struct SceneCue {
  std::size_t scene = 0;  ///< its index, in the order of the configuration
  bool shown = true;
  bool hide_others = false;  ///< hide every other scene in the same time
  double over_s = 0.0;       ///< duration of the fade, at least 0
};

/// All scenes of an installation, each at its place and with its gain on the wind, stepped together, and the encoder of
/// their frames. A hidden scene is not stepped. It has no clock: the daemon's loop, the lock-step replay and the tests
/// step it.
///
/// Thread-safe: no. step(), cue() and encode() are realtime-safe; with [animation] threads above 1 a step waits for the
/// pool's threads (WorkerPool). Poses do not depend on the number of threads.
class Animation {
 public:
  /// `gusts`: of the wind that step() will be given.
  Animation(const settings::Config& config, const std::shared_ptr<const wind::turbulence::GustNoise>& gusts);

  /// Writes the wind onto the tapes, and advances every visible scene and every fade by dt_s.
  void step(const wind::ground::DrivingWind& wind, double dt_s) noexcept;

  /// Begins a fade. Ignored for a scene that does not exist.
  void cue(const SceneCue& cue) noexcept;

  /// The frame of the present poses, size prefix included; valid until the next call.
  std::span<const std::uint8_t> encode(const wire::FrameInfo& info) {
    return encoder_.encode(info, skeletons_, poses_, opacities_);
  }

  /// The size of a frame in which every scene is visible, which is the largest.
  std::size_t largest_frame_bytes() const noexcept { return largest_frame_bytes_; }

  /// The skeletons, for clients that join.
  wire::Scenes describe() const;

  std::span<const pose::Skeleton* const> skeletons() const noexcept { return skeletons_; }
  std::span<const pose::Pose* const> poses() const noexcept { return poses_; }
  std::span<const float> opacities() const noexcept { return opacities_; }
  std::size_t node_count() const;
  /// From the middle of the scenes to the farthest place of any of them, hidden or not.
  double reach_m() const noexcept { return pose::scenes_reach_m(skeletons_); }

 private:
  std::vector<std::string> names_, kinds_;
  std::vector<std::unique_ptr<scenes::Scene>> scenes_;
  workers::WorkerPool pool_;
  wind::ground::WindTapes tapes_;
  std::vector<double> gains_;
  std::vector<Fade> fades_;
  std::vector<const pose::Skeleton*> skeletons_;
  std::vector<const pose::Pose*> poses_;
  std::vector<float> opacities_;
  wire::FrameEncoder encoder_;
  std::size_t largest_frame_bytes_ = 0;
};

}  // namespace yuragi::daemon::animation
