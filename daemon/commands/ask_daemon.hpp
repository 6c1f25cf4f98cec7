#pragma once

#include <string>

#include "daemon/tools/sensors/daemon_status.hpp"
#include "engine/base/result.hpp"

namespace yuragi::daemon::commands {

/// Requests the status of the daemon at `address` ("HOST:PORT"). `client`: the name of the command in the daemon's log.
/// Fails if there is no reply within 5 s, or it refuses the connection or has another protocol. Changes nothing.
Result<tools::sensors::DaemonStatus, Failure> ask_daemon(const std::string& address, const std::string& client);

}  // namespace yuragi::daemon::commands
