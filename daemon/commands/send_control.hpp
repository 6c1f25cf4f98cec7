#pragma once

#include <string>

#include "engine/wire/wire.hpp"

namespace yuragi::daemon::commands {

/// Sends a Control to a running daemon and waits for the reply. `client`: the name of the command in the daemon's log.
/// Throws FailureError where no daemon replies, or it refuses the connection or has another protocol.
wire::ControlReply send_control(const std::string& address, const std::string& client, const wire::Control& control);

}  // namespace yuragi::daemon::commands
