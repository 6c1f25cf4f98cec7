#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "daemon/service/watchdog_feed.hpp"
#include "engine/platform/notify_socket.hpp"
#include "engine/wire/wire.hpp"

namespace yuragi::daemon::service {

/// Reports to systemd that the daemon is ready, a line on its state, that it ends, and that it is alive.
/// If nothing listens (NOTIFY_SOCKET is not set), every call does nothing. Never waits: a message that a hanging
/// service manager does not take is sent again later. For the I/O thread.
class Manager {
 public:
  /// Reads NOTIFY_SOCKET, WATCHDOG_USEC and WATCHDOG_PID. `with_animation`: the watchdog watches the animation, too.
  explicit Manager(bool with_animation);
  /// READY=1, until it is taken.
  void report_ready();

  /// RELOADING=1, which the next READY=1 ends.
  void report_reloading();

  /// RELOADING=1: the process goes on as another program, whose READY=1 ends it.
  void report_restarting();

  /// STATUS=: one plain line, of the status that clients get. Sent if it differs from the last line.
  void report_status(const wire::Sensors& status);

  /// STOPPING=1.
  void report_stopping(const std::string& why);

  /// Call when the I/O thread has completed a round; `animation_ticks`: the animation's ticks so far. Feeds the
  /// watchdog if that is due.
  void went_round(MonoTime now, std::uint64_t animation_ticks);

 private:
  Manager(platform::ServiceEnvironment service, bool with_animation);

  platform::NotifySocket socket_;
  std::optional<WatchdogFeed> watchdog_;
  bool is_ready_ = false;
  std::string status_;
};

}  // namespace yuragi::daemon::service
