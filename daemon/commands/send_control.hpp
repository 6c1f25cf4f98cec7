#pragma once

#include <string>

#include "engine/wire/wire.hpp"

namespace yuragi {

/// Sends a running daemon a Control and waits for its answer. `client`: how the command is called in the daemon's log.
/// Throws ExitError or FailureError where no daemon answers, or it refuses the connection or speaks another protocol.
wire::ControlReply send_control(const std::string& address, const std::string& client, const wire::Control& control);

}  // namespace yuragi
