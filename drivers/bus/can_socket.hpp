#pragma once

#include <functional>
#include <memory>

#include "drivers/bus/byte_port.hpp"

namespace yuragi::drivers::bus {

/// Opens the socket of a CAN interface, which does not block: each read is one `struct can_frame` of the kernel's.
/// Returns a negative number on failure, with the reason in errno.
using OpenCanSocket = std::function<int(const BytePortAddress& address)>;

/// The kernel's.
int open_can_socket(const BytePortAddress& address);

/// A port whose lines are the frames of a CAN interface. A machine whose kernel has no CAN can test it with another
/// socket.
std::unique_ptr<BytePort> make_can_port(const BytePortAddress& address, OpenCanSocket open_socket = open_can_socket);

}  // namespace yuragi::drivers::bus
