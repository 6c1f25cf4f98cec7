#pragma once

#include <string>

#include "daemon/tools/sensors/daemon_status.hpp"
#include "engine/base/result.hpp"

namespace yuragi::daemon::commands {

/// Asks the daemon at `address` ("HOST:PORT") how it does. `client`: the name of the command in the daemon's log. Fails
/// if none answers within 5 s, or it refuses the connection or has another protocol. Changes nothing.
Result<tools::sensors::DaemonStatus, Failure> ask_daemon(const std::string& address, const std::string& client);

}  // namespace yuragi::daemon::commands
