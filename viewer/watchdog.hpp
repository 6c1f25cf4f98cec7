#pragma once

#include <optional>
#include <string>

namespace yuragi::viewer {

/// Tells systemd that pictures are being made (WATCHDOG=1): where they stop, because a driver hangs, it restarts the
/// viewer. Does nothing where nobody listens. Never waits, and never fails: what is not taken is said again later.
///
/// Source: sd_notify(3) and sd_watchdog_enabled(3) of systemd 252. WATCHDOG_PID is not looked at: on a wall the unit's
/// main process is xinit, which starts the viewer (NotifyAccess=all).
class Watchdog {
 public:
  /// Reads NOTIFY_SOCKET and WATCHDOG_USEC. During set-up, when no thread changes the environment.
  Watchdog();
  /// `socket_name`: a path, or a name in Linux's abstract namespace after '@'. `timeout_s`: nothing is no watchdog.
  Watchdog(std::string socket_name, std::optional<double> timeout_s);
  ~Watchdog();
  Watchdog(const Watchdog&) = delete;
  Watchdog& operator=(const Watchdog&) = delete;

  /// The main loop has gone round. Says so at once, and then each half of the time-out.
  void went_round(double now_s);

 private:
  std::string socket_name_;
  double interval_s_ = 0.0;
  int socket_ = -1;
  std::optional<double> said_s_;
};

}  // namespace yuragi::viewer
