#pragma once

#include <string>

#include "daemon/tools/sensors/daemon_status.hpp"
#include "engine/base/result.hpp"
#include "engine/base/time.hpp"
#include "engine/wire/wire.hpp"

namespace yuragi::daemon::commands {

/// Requests the status of the daemon at `address` ("HOST:PORT"). `client`: the name of the command in the daemon's log.
/// Fails if there is no reply within 5 s, or it refuses the connection or has another protocol. Changes nothing.
Result<tools::sensors::DaemonStatus, Failure> ask_daemon(const std::string& address, const std::string& client);

/// Sends a Control to a running daemon, with this installation's token (settings::own_token()), and waits for the
/// reply. `client`: the name of the command in the daemon's log. A refusal also reports a token that cannot be read.
/// Throws FailureError if no daemon replies, or if it refuses the connection or has another protocol.
wire::ControlReply send_control(const std::string& address, const std::string& client, const wire::Control& control,
                                Nanoseconds timeout = std::chrono::seconds(5));

}  // namespace yuragi::daemon::commands
