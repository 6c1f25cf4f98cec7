#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "drivers/bus/byte_port.hpp"
#include "drivers/sensor/found_device.hpp"

namespace yuragi::drivers::sensor {

// What drivers share whose devices are at the end of a serial line: that of this machine, or one that a server in the
// network has. Thread-safe: yes.

/// Of a port that is a serial one, or else TCP: `bauds` are the rates that the device can have. Throws
/// std::runtime_error, naming the setting and saying what to do, if they cannot work together.
void check_serial_or_tcp(const bus::BytePortAddress& address, std::span<const int> bauds = bus::kBytePortBauds);

/// The serial ports that are plugged in. Whether such a device is behind one is not known before it is opened. What
/// else stands in its [[sensor]] table: `before` and `behind` the line of the port, each with its own ends of lines.
std::vector<FoundDevice> find_behind_serial_ports(std::string_view before = {}, std::string_view behind = {});

}  // namespace yuragi::drivers::sensor
