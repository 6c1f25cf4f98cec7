#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/settings/control_permission.hpp"
#include "drivers/recording/recording_player.hpp"
#include "engine/base/time.hpp"
#include "engine/wire/wire.hpp"

namespace yuragi::daemon::sensing {

/// A sensor that plays a recording.
struct NamedPlayer {
  std::string sensor;
  drivers::recording::Player* player = nullptr;  ///< must outlive the director
  std::function<void()> wake;                    ///< makes its thread read orders at once
};

/// Handles clients' requests about recordings that play, on the I/O thread: checks the permission ([stream] control),
/// passes orders to the sensors' threads, and reports positions.
///
/// Thread-safe: no.
class PlayerDirector {
 public:
  /// `allowed`: [stream] control.
  PlayerDirector(settings::ControlPermission allowed, std::vector<NamedPlayer> players);

  /// Changes who may give orders.
  void allow(settings::ControlPermission allowed) { allowed_ = allowed; }

  /// Carries out a client's command; the reply has the reason for a refusal. `is_local`: the client is on this machine.
  wire::ControlReply handle(const wire::PlayerCommand& command, bool is_local);

  /// The time of the recording machine's clock at the present position: by the newest reading, plus the time since.
  /// Nullopt until a recording plays.
  std::optional<UtcTime> recorded_clock() const;

 private:
  wire::PlayerState state_of(const NamedPlayer& named) const;

  settings::ControlPermission allowed_;
  std::vector<NamedPlayer> players_;
};

}  // namespace yuragi::daemon::sensing
