#include "drivers/bus/byte_port.hpp"

#include <boost/asio/ip/address.hpp>
#include <fmt/format.h>

#include "drivers/bus/serial_ports.hpp"

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
    case BytePortKind::kWebSocket:
      return "ws://" + host_and_port(address.host, address.port);
    case BytePortKind::kFile:
      return address.path;
    case BytePortKind::kCan:
      return "CAN interface " + address.path;
  }
  return "?";
}

std::string sole_device_of(const BytePortAddress& address) {
  if (address.kind == BytePortKind::kSerial) return serial_device_of(address.path);
  if (address.kind != BytePortKind::kUdp || address.is_port_shared) return {};
  boost::system::error_code error;
  const auto local = boost::asio::ip::make_address(address.host, error);
  if (!error && local.is_multicast()) return {};
  return fmt::format("UDP port {}", address.port);
}

}  // namespace yuragi::drivers::bus
