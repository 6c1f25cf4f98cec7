#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "drivers/bus/interruption.hpp"
#include "drivers/decode/modbus/modbus.hpp"
#include "engine/base/result.hpp"
#include "engine/base/time.hpp"

namespace yuragi::drivers::bus {

/// Where Modbus devices are reached.
struct ModbusLine {
  decode::modbus::Framing framing = decode::modbus::Framing::kTcp;

  std::string host;  ///< TCP: a name, an IPv4 or an IPv6 address
  std::uint16_t port = 502;

  std::string device;  ///< RTU: the serial port, best by its stable name under /dev/serial/by-id
  int baud = 9600;
  char parity = 'N';  ///< N, E or O
  int stop_bits = 1;

  Nanoseconds connect_timeout = std::chrono::seconds(1);  ///< TCP
};

/// How long a device may take.
struct ModbusPatience {
  Nanoseconds response_timeout = std::chrono::milliseconds(500);  ///< from request to the end of the reply
  Nanoseconds byte_timeout = std::chrono::milliseconds(50);       ///< RTU: this silence on the line ends a message
};

/// "host:port", or the serial port: for people.
std::string describe(const ModbusLine& line);

/// The silence that separates two messages on a serial line: 3.5 characters, or 1.75 ms above 19200 bit/s (MODBUS over
/// Serial Line V1.02, section 2.5.1.1); zero over TCP.
Nanoseconds frame_gap(const ModbusLine& line) noexcept;

/// The result of waiting for a reply.
enum class Status : std::uint8_t {
  kMessage,      ///< a message, not decoded yet
  kSilence,      ///< no byte until the response timeout
  kCutOff,       ///< the beginning of a message, then no byte until the response timeout
  kGarbled,      ///< bytes that are not a message; message boundaries are lost
  kInterrupted,  ///< the interruption was set
  kLost,         ///< the connection is gone
};

struct Message {
  Status status = Status::kSilence;
  std::size_t size = 0;  ///< bytes, for kMessage
};

/// A connection to the devices on one line, which can be closed and opened again. Carries bytes without interpreting
/// them. A test may substitute another. An `interruption` that is set ends every call that waits with it, at once.
///
/// Thread-safe: no; one thread after the other may use it.
class ModbusConnection {
 public:
  virtual ~ModbusConnection() = default;

  /// Opens. The failure's text: why, and what to do. Blocks for the connect time-out at most (and while the system
  /// looks up a host name).
  virtual Result<void, Failure> open(const Interruption& interruption) = 0;
  virtual bool is_open() const noexcept = 0;
  /// Errors while closing are ignored: the descriptor is closed in any case.
  virtual void close() noexcept = 0;

  /// Reads from the line until it has been quiet for the byte time-out, or chattering for the response time-out,
  /// and returns how much of it is in `buffer` (the rest is dropped). Over TCP there is nothing to wait for: 0.
  virtual std::size_t settle(std::span<std::uint8_t, decode::modbus::kModbusMaxMessage> buffer,
                             const ModbusPatience& patience, const Interruption& interruption) = 0;

  /// Sends a request and starts its response time-out. On a serial line, unrequested bytes are discarded first. Returns
  /// false if the connection is lost.
  virtual bool send(const decode::modbus::Request& request, const ModbusPatience& patience) = 0;

  /// The next message since, waiting until the response time-out that send() began. Can be called again after a message
  /// that was another slave's.
  virtual Message receive(std::span<std::uint8_t, decode::modbus::kModbusMaxMessage> buffer,
                          const Interruption& interruption) = 0;
};

/// The real one, by libmodbus.
std::unique_ptr<ModbusConnection> make_modbus_connection(const ModbusLine& line);

}  // namespace yuragi::drivers::bus
