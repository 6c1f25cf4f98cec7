#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "daemon/settings/config.hpp"
#include "daemon/tools/offline/lockstep_replay.hpp"

namespace yuragi::daemon::tools::offline {

/// A replay in lock-step as the stream that a daemon sends (pose.fbs): a Hello and the Scenes, then a Frame for each
/// tick, none left out, with the recording's clock as its UTC. The light and the cameras come as Sensors without any
/// sensor, at first and when another camera is on. A ControlReply of one player first gives the remaining length.
///
/// So a reader gets the same bytes every time, as fast as it takes them. Thread-safe: no.
class ReplayStream {
 public:
  /// Takes the bytes of whole messages; may wait. What it throws ends the replay.
  using Write = std::function<void(std::span<const std::uint8_t> bytes)>;

  /// `config`: what is replayed.
  ReplayStream(const settings::Config& config, Write write);

  /// Throws ConfigError if the scenes are larger than a client takes.
  void write(const ReplayTick& tick);

 private:
  void begin(const ReplayTick& tick);
  void write_status(const ReplayTick& tick, std::size_t camera);

  const settings::Config& config_;
  Write write_;
  std::vector<look::Camera> cameras_;
  std::optional<std::size_t> camera_;  // that is on
  std::uint64_t ticks_ = 0;
};

}  // namespace yuragi::daemon::tools::offline
