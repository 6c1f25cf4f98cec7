#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "engine/base/result.hpp"
#include "engine/base/time.hpp"

namespace yuragi {

/// One OSC message.
struct OscMessage {
  std::string address;                         ///< "/wind"
  std::vector<std::optional<double>> numbers;  ///< its arguments in their order; empty: not a number
};

/// What one datagram held. A bundle holds many messages; when they are meant for does not matter: wind is now.
struct OscDatagram {
  std::vector<std::uint8_t> bytes;
  std::vector<OscMessage> messages;
  bool is_well_formed = false;  ///< all of it; otherwise `messages` is empty
};

enum class OscStatus : std::uint8_t {
  kDatagram,
  kSilence,      ///< none until the time-out
  kInterrupted,  ///< interrupt() was called
  kLost,         ///< the port is gone
};

/// A UDP port that OSC messages come to, from anywhere. A test may put another in its place.
///
/// Thread-safe: interrupt() alone; everything else belongs to one thread.
class OscServer {
 public:
  virtual ~OscServer() = default;

  /// Takes the port, or says why that failed and what to do.
  virtual Result<void, Failure> open() = 0;
  virtual void close() noexcept = 0;

  /// The next datagram, waiting for at most `timeout`.
  virtual OscStatus receive(OscDatagram& datagram, Nanoseconds timeout) = 0;

  /// Ends a receive() that waits and makes all later ones end at once.
  virtual void interrupt() noexcept = 0;
};

/// The real one, by liblo.
std::unique_ptr<OscServer> make_osc_server(std::uint16_t port);

/// Is `address` one of those that `pattern` stands for? OSC's own patterns: ? * [a-z] {this,that}.
bool osc_address_matches(const std::string& address, const std::string& pattern);

}  // namespace yuragi
