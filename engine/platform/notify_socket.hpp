#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "engine/base/time.hpp"

namespace yuragi::platform {

/// The socket on which a service manager listens, if there is one. Never waits. Thread-safe: no.
///
/// Source: sd_notify(3) and sd_watchdog_enabled(3) of systemd 252, whose protocol is declared stable. sd_notify()
/// itself is not used, because it waits while the manager's queue is full.
class NotifySocket {
 public:
  /// `name`: a path, or a name in Linux's abstract namespace after '@'; empty: no service manager.
  explicit NotifySocket(std::string name);
  ~NotifySocket();
  NotifySocket(const NotifySocket&) = delete;
  NotifySocket& operator=(const NotifySocket&) = delete;

  /// Does somebody listen?
  bool is_open() const noexcept { return socket_ >= 0; }

  /// Sends a message, such as "READY=1". Returns false if it was not taken; without a service manager it returns true.
  bool send(std::string_view message) const;

 private:
  std::string name_;
  int socket_ = -1;
};

/// The service manager's socket and watchdog, from the environment. To be read during set-up, when no thread changes
/// the environment.
struct ServiceEnvironment {
  std::string socket_name;              ///< NOTIFY_SOCKET; empty: none
  std::optional<Nanoseconds> watchdog;  ///< WATCHDOG_USEC; nullopt if missing, not a number, or over 11 days
  bool is_ours = true;                  ///< WATCHDOG_PID is this process, or is absent

  static ServiceEnvironment read();
};

}  // namespace yuragi::platform
