#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "simulators/faults.hpp"

namespace yuragi::sim {

/// What carries the bytes of a simulated device that says text. It never waits: what nobody takes is lost.
class TextWire {
 public:
  virtual ~TextWire() = default;

  /// What can happen to the wire itself.
  virtual std::span<const FaultKind> known_faults() const = 0;
  /// What brings bytes, or somebody who wants to listen.
  virtual std::vector<int> descriptors() const = 0;
  /// What those who listen have said; `ready` are the descriptors that can be read.
  virtual std::string read(std::span<const int> ready) = 0;
  /// Says it to all who listen.
  virtual void write(std::string_view bytes) = 0;

  /// The wire is gone: its port, its connections. Again: nothing.
  virtual void take_away() = 0;
  /// It is back where it was. Again: nothing.
  virtual void bring_back() = 0;

  /// "listening on /dev/pts/3", "listening on 127.0.0.1:10110", "sending to 127.0.0.1:10110".
  virtual std::string place() const = 0;
};

/// A serial port; `link`, if not empty, is the name that it has each time it is plugged in. Throws std::system_error.
std::unique_ptr<TextWire> make_pty_wire(const std::string& link);

/// A TCP server; port 0 takes a free one. Throws std::runtime_error where the address cannot be had.
std::unique_ptr<TextWire> make_tcp_wire(const std::string& host, std::uint16_t port);

/// Datagrams to one address, one for each write. Throws std::runtime_error for what is no address.
std::unique_ptr<TextWire> make_udp_wire(const std::string& host, std::uint16_t port);

}  // namespace yuragi::sim
