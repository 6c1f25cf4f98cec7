#pragma once

#include <cstdint>
#include <string>

#include "drivers/bus/wake_event.hpp"
#include "engine/base/result.hpp"
#include "engine/base/time.hpp"

namespace yuragi {

/// Connects to a TCP server, by name or address, and returns the socket, which is the caller's to close: blocking,
/// small messages at once. Waits for `timeout` at most (and while the system looks up a name), less if `wake` is set.
/// The failure is the system's reason: "Connection refused".
Result<int, Failure> connect_tcp(const std::string& host, std::uint16_t port, Nanoseconds timeout,
                                 const WakeEvent& wake);

}  // namespace yuragi
