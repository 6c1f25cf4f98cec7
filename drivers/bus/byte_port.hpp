#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "engine/base/result.hpp"
#include "engine/base/time.hpp"

namespace yuragi {

/// Where bytes come from, one after the other.
enum class BytePortKind : std::uint8_t {
  kSerial,     ///< a serial port
  kTcpClient,  ///< a server in the network that we connect to
  kUdp,        ///< datagrams that come to one of our ports
  kFile,       ///< a file or named pipe; a file that has been read to its end is not lost, it says nothing more
};

struct BytePortAddress {
  BytePortKind kind = BytePortKind::kSerial;

  std::string path;  ///< serial: best by its stable name under /dev/serial/by-id; file: its path
  int baud = 9600;
  int data_bits = 8;
  char parity = 'N';  ///< N, E or O
  int stop_bits = 1;

  std::string host;  ///< TCP: name or address to connect to; UDP: the local address to listen at
  std::uint16_t port = 10110;

  Nanoseconds connect_timeout = std::chrono::seconds(3);
};

/// "/dev/ttyUSB0 at 9600 8N1", "host:port", "UDP port 10110": for people.
std::string describe(const BytePortAddress& address);

enum class ByteStatus : std::uint8_t {
  kBytes,        ///< some have come
  kSilence,      ///< none until the time-out
  kEnd,          ///< of a file
  kInterrupted,  ///< interrupt() was called
  kLost,         ///< the port is gone
};

struct ByteArrival {
  ByteStatus status = ByteStatus::kSilence;
  std::size_t size = 0;            ///< for kBytes
  bool is_whole_datagram = false;  ///< UDP: what has come ends here
};

/// A port that can be closed and opened again for as long as it lives. Carries bytes and judges nothing. A test may put
/// another in its place.
///
/// Thread-safe: interrupt() alone; everything else belongs to one thread.
class BytePort {
 public:
  virtual ~BytePort() = default;

  /// Opens, or says why that failed and what to do. Blocks for the connect time-out at most.
  virtual Result<void, Failure> open() = 0;
  virtual void close() noexcept = 0;

  /// The next bytes, waiting for at most `timeout`.
  virtual ByteArrival read(std::span<std::uint8_t> buffer, Nanoseconds timeout) = 0;

  /// Sends all of it (serial and TCP). False: the port is lost, or cannot be written to.
  virtual bool write(std::span<const std::uint8_t> bytes) = 0;

  /// Ends a read() or open() that waits and makes all later work end at once.
  virtual void interrupt() noexcept = 0;
};

/// The real one, by Boost.Asio.
std::unique_ptr<BytePort> make_byte_port(const BytePortAddress& address);

}  // namespace yuragi
