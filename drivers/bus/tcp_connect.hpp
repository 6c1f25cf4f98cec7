#pragma once

#include "drivers/bus/host_lookup.hpp"
#include "drivers/bus/interruption.hpp"
#include "engine/base/result.hpp"
#include "engine/base/time.hpp"

namespace yuragi::drivers::bus {

/// Connects to one of a host's addresses and returns the socket, which is the caller's to close: blocking, small
/// messages at once, and noticing after about 25 s a peer that vanished silently. Looking up the name and
/// connecting take `timeout` each at most, less if `interruption` is set. The failure is the reason: "Connection
/// refused".
Result<int, Failure> connect_tcp(HostLookup& host, Nanoseconds timeout, const Interruption& interruption);

}  // namespace yuragi::drivers::bus
