#pragma once

#include <optional>

#include "engine/platform/notify_socket.hpp"

namespace yuragi::viewer::app {

/// Tells systemd that pictures are being made (WATCHDOG=1): where they stop, because a driver hangs, it restarts the
/// viewer. Does nothing where nobody listens. Never waits, and never fails: what is not taken is said again later.
///
/// WATCHDOG_PID is not looked at: on a wall the unit's main process is xinit, which starts the viewer
/// (NotifyAccess=all).
class Watchdog {
 public:
  /// Reads the environment. During set-up, when no thread changes it.
  Watchdog();
  explicit Watchdog(platform::ServiceEnvironment service);

  /// The main loop has gone round. Says so at once, and then each half of the time-out.
  void went_round(double now_s);

 private:
  platform::NotifySocket socket_;
  std::optional<double> interval_s_;  ///< none: nobody waits for it
  std::optional<double> said_s_;
};

}  // namespace yuragi::viewer::app
