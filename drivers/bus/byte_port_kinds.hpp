#pragma once

#include <memory>

#include "drivers/bus/byte_port.hpp"

namespace yuragi::drivers::bus {

/// The real one. Serial ports and sockets are Boost.Asio's. Throws std::system_error if the process has no
/// descriptors left.
///
/// A serial port is locked against other programs while it is open (flock, and TIOCEXCL against those that do not ask
/// for locks). Opening it raises DTR and closing it lowers DTR again, which restarts most Arduinos.
std::unique_ptr<BytePort> make_byte_port(const BytePortAddress& address);

}  // namespace yuragi::drivers::bus
