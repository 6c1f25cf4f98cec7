#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include "engine/base/result.hpp"
#include "engine/base/secret.hpp"
#include "engine/base/time.hpp"

namespace yuragi::drivers::bus {

/// The kinds of byte ports.
enum class BytePortKind : std::uint8_t {
  kSerial,     ///< a serial port
  kTcpClient,  ///< a client of a server in the network
  kUdp,        ///< datagrams to a local port
  kWebSocket,  ///< a client of a WebSocket server (RFC 6455), whose messages are carried as datagrams are
  kFile,       ///< a file or named pipe
  kCan,        ///< a CAN interface: a line for each frame, as candump -L writes it
};

/// Which frames of a CAN bus are received: those of 29 bits whose identifier is the same in the bits of the mask.
struct CanFilter {
  std::uint32_t identifier = 0;
  std::uint32_t mask = 0;
};

/// The rates that a serial port can have.
inline constexpr std::array<int, 12> kBytePortBauds = {300,   600,   1200,  2400,   4800,   9600,
                                                       19200, 38400, 57600, 115200, 230400, 460800};

struct BytePortAddress {
  BytePortKind kind = BytePortKind::kSerial;

  /// Serial: best by its stable name under /dev/serial/by-id. File: its path. WebSocket: the requested path, "/stream".
  /// CAN: the interface's name.
  std::string path = {};
  int baud = 9600;  ///< one of kBytePortBauds
  int data_bits = 8;
  char parity = 'N';  ///< N, E or O
  int stop_bits = 1;

  /// TCP, WebSocket: name or address to connect to. UDP: the local or multicast address to listen at; empty: any.
  std::string host = {};
  std::uint16_t port = 10110;
  std::string senders = {};  ///< UDP: take datagrams of these addresses and nets only (SenderFilter); empty: of any
  /// UDP: other programs that also set this (SO_REUSEADDR) can listen at the port, too. All of them receive broadcasts;
  /// datagrams to this machine alone are received only by the program that bound last.
  bool is_port_shared = false;

  /// File: from its beginning to its end, once. Otherwise from the first line that is appended to it, without end,
  /// also when it is truncated or replaced. A named pipe is always read without end, by any number of writers.
  bool is_played = false;

  CanFilter can = {};

  /// WebSocket: sent only as "Authorization: Bearer ...", unencrypted; empty: not sent.
  Secret token = {};
  /// WebSocket: a server that sends nothing for half of this time is pinged; after all of it the connection is lost.
  Nanoseconds idle_timeout = std::chrono::seconds(30);

  Nanoseconds connect_timeout = std::chrono::seconds(3);
};

/// "/dev/ttyUSB0 at 9600 8N1", "host:port", "UDP port 10110", "ws://host:port", "CAN interface can0", a path: for
/// people.
std::string describe(const BytePortAddress& address);

/// The identity of what a port is connected to, for people, too: "serial port /dev/ttyUSB0", "192.168.1.21:10110",
/// "UDP port 10110", "UDP 239.1.2.3:10110" (a multicast group), "CAN interface can0", "file /tmp/wind". Files and
/// devices are those behind their links, names of hosts in small letters; no name is looked up.
std::string device_of(const BytePortAddress& address);

/// The settings that select it: "host, port".
std::string_view keys_of(BytePortKind kind) noexcept;

/// device_of() a port that sensors of different drivers cannot both have: a serial port, a UDP port that is no
/// multicast group's. Empty: all may open it.
std::string sole_device_of(const BytePortAddress& address);

enum class ByteStatus : std::uint8_t {
  kBytes,        ///< some have come
  kForeign,      ///< a datagram of another sender than configured, discarded
  kSilence,      ///< none until the time-out
  kEnd,          ///< the end of a file that is played
  kInterrupted,  ///< interrupt() was called
  kLost,         ///< the port is gone
};

struct ByteArrival {
  ByteStatus status = ByteStatus::kSilence;
  std::size_t size = 0;            ///< for kBytes
  bool is_whole_datagram = false;  ///< UDP, WebSocket, CAN: these bytes end a datagram, message or frame
  std::string sender = {};         ///< UDP, for kForeign: its address
  std::uint32_t overrun = 0;       ///< UDP: how many datagrams before this one the kernel dropped for want of room
};

/// A datagram that is longer than its buffer loses its end; this is enough for any. A WebSocket's message that is
/// longer ends the connection.
inline constexpr std::size_t kMaxDatagram = 65536;

/// A port that can be closed and opened again. Carries bytes without interpreting them. A test may substitute another.
///
/// Thread-safe: interrupt() alone; everything else belongs to one thread.
class BytePort {
 public:
  virtual ~BytePort() = default;

  /// Opens. The failure's text: why, and what to do. Blocks for the connect time-out at most, or twice that where a
  /// host name has to be looked up, and once more for the handshake of a WebSocket.
  virtual Result<void, Failure> open() = 0;
  virtual void close() noexcept = 0;

  /// The next bytes, waiting for at most `timeout`; 0: without waiting. kLost while it is not open.
  virtual ByteArrival read(std::span<std::uint8_t> buffer, Nanoseconds timeout) = 0;

  /// Sends all of it (serial, TCP; WebSocket: as one message of text). Returns false if the port is lost, takes no byte
  /// for a second, or cannot be written to.
  virtual bool write(std::span<const std::uint8_t> bytes) = 0;

  /// Ends a read(), write() or open() that waits and makes all later work end at once. Data that the port takes without
  /// waiting can still be written: a last message to the device.
  virtual void interrupt() noexcept = 0;
};

}  // namespace yuragi::drivers::bus
