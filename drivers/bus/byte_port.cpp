#include "drivers/bus/byte_port.hpp"

#include <fmt/format.h>

namespace yuragi::drivers::bus {
namespace {

std::string host_and_port(const std::string& host, std::uint16_t port) {
  const bool is_ipv6 = host.find(':') != std::string::npos;
  return is_ipv6 ? fmt::format("[{}]:{}", host, port) : fmt::format("{}:{}", host, port);
}

}  // namespace

std::string describe(const BytePortAddress& address) {
  switch (address.kind) {
    case BytePortKind::kSerial:
      return fmt::format("{} at {} {}{}{}", address.path, address.baud, address.data_bits, address.parity,
                         address.stop_bits);
    case BytePortKind::kTcpClient:
      return host_and_port(address.host, address.port);
    case BytePortKind::kUdp:
      return address.host.empty() ? fmt::format("UDP port {}", address.port)
                                  : "UDP " + host_and_port(address.host, address.port);
    case BytePortKind::kFile:
      return address.path;
  }
  return "?";
}

}  // namespace yuragi::drivers::bus
