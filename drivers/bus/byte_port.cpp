#include "drivers/bus/byte_port.hpp"

#include <cerrno>

#include <fmt/format.h>
#include <unistd.h>

#include "drivers/bus/descriptor_port.hpp"

namespace yuragi {
namespace {

/// A device that takes nothing for so long will not take it later either.
constexpr Nanoseconds kWritePatience = std::chrono::seconds(1);

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

std::unique_ptr<BytePort> make_byte_port(const BytePortAddress& address) {
  switch (address.kind) {
    case BytePortKind::kSerial:
      return make_serial_port(address);
    case BytePortKind::kTcpClient:
      return make_tcp_port(address);
    case BytePortKind::kUdp:
      return make_udp_port(address);
    case BytePortKind::kFile:
      break;
  }
  return make_file_port(address);
}

ByteArrival DescriptorPort::read(std::span<std::uint8_t> buffer, Nanoseconds timeout) {
  if (descriptor() < 0) return {ByteStatus::kLost};
  switch (interruption_.wait(descriptor(), WaitFor::kReadable, timeout)) {
    case WaitEnd::kInterrupted:
      return {ByteStatus::kInterrupted};
    case WaitEnd::kTimeout:
      return {ByteStatus::kSilence};
    case WaitEnd::kReady:
      break;
  }
  const ssize_t size = ::read(descriptor(), buffer.data(), buffer.size());
  if (size > 0) return {ByteStatus::kBytes, static_cast<std::size_t>(size)};
  const bool is_nothing = size < 0 && (errno == EAGAIN || errno == EINTR);
  return {is_nothing ? ByteStatus::kSilence : ByteStatus::kLost};
}

bool DescriptorPort::write(std::span<const std::uint8_t> bytes) {
  while (!bytes.empty()) {
    if (descriptor() < 0) return false;
    if (interruption_.wait(descriptor(), WaitFor::kWritable, kWritePatience) != WaitEnd::kReady) return false;
    const ssize_t size = ::write(descriptor(), bytes.data(), bytes.size());
    if (size > 0) {
      bytes = bytes.subspan(static_cast<std::size_t>(size));
    } else if (errno != EAGAIN && errno != EINTR) {
      return false;
    }
  }
  return true;
}

}  // namespace yuragi
