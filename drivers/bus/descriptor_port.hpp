#pragma once

#include <memory>

#include "drivers/bus/byte_port.hpp"
#include "drivers/bus/interruption.hpp"

namespace yuragi::drivers::bus {

/// The common part of byte ports with a file descriptor: reading, writing and being interrupted. A kind of port adds
/// how to open it.
class DescriptorPort : public BytePort {
 public:
  explicit DescriptorPort(const BytePortAddress& address) : address_(address) {}

  ByteArrival read(std::span<std::uint8_t> buffer, Nanoseconds timeout) override;
  bool write(std::span<const std::uint8_t> bytes) override;
  void interrupt() noexcept override { interruption_.set(); }

 protected:
  /// That of the open port, which does not block; -1 while it is closed.
  virtual int descriptor() noexcept = 0;

  const BytePortAddress& address() const noexcept { return address_; }
  const Interruption& interruption() const noexcept { return interruption_; }

 private:
  BytePortAddress address_;
  Interruption interruption_;
};

// Each makes one kind of port, in a separate file.
std::unique_ptr<BytePort> make_serial_port(const BytePortAddress& address);
std::unique_ptr<BytePort> make_tcp_port(const BytePortAddress& address);
std::unique_ptr<BytePort> make_udp_port(const BytePortAddress& address);
std::unique_ptr<BytePort> make_websocket_port(const BytePortAddress& address);
std::unique_ptr<BytePort> make_file_port(const BytePortAddress& address);

}  // namespace yuragi::drivers::bus
