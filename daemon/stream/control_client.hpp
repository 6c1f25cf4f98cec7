#pragma once

#include <string>
#include <string_view>

#include "engine/base/result.hpp"
#include "engine/base/secret.hpp"
#include "engine/base/time.hpp"
#include "engine/wire/wire.hpp"

namespace yuragi::daemon::stream {

/// Sends a Control to the daemon at `address` and waits for the reply, `timeout` at most. `client`: a name for the
/// daemon's log; `token`: the installation's, empty: none is shown. Fails (kUnavailable) if no daemon replies, and
/// if it refuses the connection or speaks another protocol. Thread-safe: yes.
Result<wire::ControlReply, Failure> ask(const std::string& address, std::string_view client,
                                        const wire::Control& control, Nanoseconds timeout, const Secret& token = {});

/// Asks the daemon at `address` to read its configuration again, and returns the result. `file`: as
/// ReloadCommand::file. Fails as ask() does, and if the daemon is an older one that cannot do it. Waits as long as
/// reading a file and making scenes may take. Thread-safe: yes.
Result<wire::ReloadReport, Failure> ask_to_reload(const std::string& address, const std::string& file,
                                                  const Secret& token = {});

/// The report in lines for a person, each with a line end.
std::string reload_text(const wire::ReloadReport& report);

}  // namespace yuragi::daemon::stream
