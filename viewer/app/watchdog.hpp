#pragma once

#include <optional>

#include "engine/platform/notify_socket.hpp"

namespace yuragi::viewer::app {

/// Reports to systemd that pictures are made (WATCHDOG=1), so that it restarts the viewer if they stop, because a
/// driver hangs. Does nothing if no watchdog is set. Never waits, and never fails: a message that was not taken is sent
/// again later.
///
/// WATCHDOG_PID is ignored: on a wall the unit's main process is xinit, which starts the viewer (NotifyAccess=all).
class Watchdog {
 public:
  /// Reads the environment. During set-up, when no thread changes it.
  Watchdog();
  explicit Watchdog(platform::ServiceEnvironment service);

  /// Call once per round of the main loop. Reports at once, and then each half of the timeout.
  void went_round(double now_s);

 private:
  platform::NotifySocket socket_;
  std::optional<double> interval_s_;  ///< nullopt: no watchdog is set
  std::optional<double> sent_s_;
};

}  // namespace yuragi::viewer::app
