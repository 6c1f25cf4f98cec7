#include "drivers/bus/byte_port.hpp"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <system_error>

#include <boost/asio/ip/address.hpp>
#include <fmt/format.h>

#include "drivers/bus/serial_ports.hpp"

namespace yuragi::drivers::bus {
namespace {

std::string host_and_port(const std::string& host, std::uint16_t port) {
  const bool is_ipv6 = host.find(':') != std::string::npos;
  return is_ipv6 ? fmt::format("[{}]:{}", host, port) : fmt::format("{}:{}", host, port);
}

bool is_multicast(const std::string& host) {
  boost::system::error_code error;
  const auto address = boost::asio::ip::make_address(host, error);
  return !error && address.is_multicast();
}

/// One text for the ways to write an address or a name.
std::string host_identity(std::string host) {
  std::ranges::transform(host, host.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (host == "localhost") return "127.0.0.1";
  boost::system::error_code error;
  const auto address = boost::asio::ip::make_address(host, error);
  return error ? host : address.to_string();
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

std::string device_of(const BytePortAddress& address) {
  BytePortAddress identity = address;
  identity.host = host_identity(address.host);
  switch (address.kind) {
    case BytePortKind::kSerial:
      return serial_device_of(address.path);
    case BytePortKind::kFile: {
      std::error_code error;
      const auto file = std::filesystem::weakly_canonical(address.path, error);
      return "file " + (error ? address.path : file.string());
    }
    case BytePortKind::kUdp:
      if (!is_multicast(address.host)) identity.host.clear();
      break;
    case BytePortKind::kTcpClient:
    case BytePortKind::kWebSocket:
    case BytePortKind::kCan:
      break;
  }
  return describe(identity);
}

std::string_view keys_of(BytePortKind kind) noexcept {
  switch (kind) {
    case BytePortKind::kSerial:
      return "device";
    case BytePortKind::kFile:
      return "file";
    case BytePortKind::kCan:
      return "interface";
    case BytePortKind::kTcpClient:
    case BytePortKind::kUdp:
    case BytePortKind::kWebSocket:
      break;
  }
  return "host, port";
}

std::string sole_device_of(const BytePortAddress& address) {
  const bool is_sole_udp = address.kind == BytePortKind::kUdp && !is_multicast(address.host);
  return address.kind == BytePortKind::kSerial || is_sole_udp ? device_of(address) : "";
}

}  // namespace yuragi::drivers::bus
