#include "drivers/sensor/serial_or_tcp.hpp"

#include <algorithm>
#include <stdexcept>

#include <fmt/format.h>

#include "drivers/bus/serial_ports.hpp"

namespace yuragi::drivers::sensor {

void check_serial_or_tcp(const bus::BytePortAddress& address, std::span<const int> bauds) {
  if (address.kind == bus::BytePortKind::kTcpClient) {
    if (address.host.empty()) throw std::runtime_error("host: is missing; transport tcp needs a server to connect to");
    return;
  }
  if (address.path.empty())
    throw std::runtime_error("device: is missing; transport serial needs a port, such as /dev/ttyUSB0");
  if (std::ranges::find(bauds, address.baud) == bauds.end())
    throw std::runtime_error(fmt::format("baud: is {}; allowed: {}", address.baud, fmt::join(bauds, ", ")));
}

std::vector<FoundDevice> find_behind_serial_ports(std::string_view before, std::string_view behind) {
  std::vector<FoundDevice> found;
  for (const bus::SerialPortInfo& port : bus::find_serial_ports()) {
    found.push_back({.what = "serial port " + port.node,
                     .settings = fmt::format("{}device = \"{}\"{}", before, port.name, behind),
                     .trouble = port.trouble,
                     .remedy = port.remedy});
  }
  return found;
}

}  // namespace yuragi::drivers::sensor
