#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/settings/control_permission.hpp"
#include "drivers/recording/recording_player.hpp"
#include "engine/wire/wire.hpp"

namespace yuragi {

/// A sensor that plays a recording.
struct NamedPlayer {
  std::string sensor;
  RecordingPlayer* player = nullptr;  ///< lives longer than the director
  std::function<void()> wake;         ///< has its thread look for orders at once
};

/// The I/O thread's side of the controls of recordings that play: judges who may use them ([stream] control), hands
/// orders over to the sensors' threads, and tells how things are.
///
/// Thread-safe: no.
class PlayerDirector {
 public:
  /// `allowed`: [stream] control.
  PlayerDirector(ControlPermission allowed, std::vector<NamedPlayer> players);

  /// Gives the orders that a client asks for, or says why not. `is_local`: it asks from this machine.
  wire::ControlReply handle(const wire::PlayerCommand& command, bool is_local);

 private:
  wire::PlayerState state_of(const NamedPlayer& named) const;

  ControlPermission allowed_;
  std::vector<NamedPlayer> players_;
};

}  // namespace yuragi
