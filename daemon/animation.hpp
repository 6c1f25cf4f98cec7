#pragma once

#include <memory>
#include <span>
#include <vector>

#include "daemon/config.hpp"
#include "engine/scenes/scene.hpp"
#include "engine/wind/wind_state.hpp"
#include "engine/wire/wire.hpp"

namespace yuragi {

/// The scenes of an installation, stepped together, and the frame that shows them. No thread, no clock: the daemon's
/// loop, the lock-step replay and the tests all step this one.
///
/// Thread-safe: no. step() and encode() are realtime-safe after the first encode().
class Animation {
 public:
  explicit Animation(const Config& config);

  /// Moves every scene on by dt_s under `wind`.
  void step(WindVector wind, double dt_s) noexcept;

  /// The frame of the present poses, size prefix included; valid until the next call.
  std::span<const std::uint8_t> encode(const wire::FrameInfo& info) {
    return encoder_.encode(info, skeletons_, poses_);
  }

  /// The skeletons, for clients that join.
  wire::Scenes describe() const;

  std::span<const Skeleton* const> skeletons() const noexcept { return skeletons_; }
  std::span<const Pose* const> poses() const noexcept { return poses_; }
  std::size_t node_count() const;

 private:
  std::vector<std::string> names_, kinds_;
  std::vector<std::unique_ptr<Scene>> scenes_;
  std::vector<const Skeleton*> skeletons_;
  std::vector<const Pose*> poses_;
  wire::FrameEncoder encoder_;
};

}  // namespace yuragi
