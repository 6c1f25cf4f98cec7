#pragma once

#include <array>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "drivers/bus/modbus_connection.hpp"
#include "drivers/sensor/sensor.hpp"

namespace yuragi::drivers::modbus {

/// Why a request gave no registers. Refusals have been counted.
struct Trouble {
  enum class Kind : std::uint8_t {
    kSilence,      ///< nothing came in time
    kOthersOnly,   ///< only messages of other slaves came
    kRefused,      ///< a message was refused: `refusal`
    kLost,         ///< the connection is gone
    kInterrupted,  ///< the interruption was set
  };
  Kind kind = Kind::kSilence;
  decode::modbus::RefusedReply refusal;  ///< for kRefused
};

/// One line with Modbus devices: a serial port, or a host and port. All sensors on that line share it, each from a
/// thread of its own, and are served one after the other in the order of their requests.
///
/// A late reply to one request is never taken for that to another. Over TCP each request has a transaction id. On a
/// serial line only the slave's id distinguishes replies, so a slave that did not reply in time gets no request for
/// another response time-out (ready_at()), and after any error nothing is sent before the line has been quiet. A device
/// that is slower than two time-outs needs a longer one.
///
/// Thread-safe: yes. A caller waits for those before it, each for one response time-out at most; its `interruption`
/// ends that.
class Bus {
 public:
  using Reply = Result<decode::modbus::Registers, Trouble>;

  Bus(const bus::ModbusLine& line, std::unique_ptr<bus::ModbusConnection> connection);

  /// The line, for people.
  const std::string& where() const noexcept { return where_; }
  decode::modbus::Framing framing() const noexcept { return line_.framing; }

  /// Returns success if sensors with these settings can share it. The failure's text names the difference.
  Result<void, Failure> suits(const bus::ModbusLine& line) const;

  /// Sets the least time from a reply to the next request of any sensor; the longest of all calls holds.
  void keep_gap(Nanoseconds min_gap);

  /// Opens the line if it is not open. Returns when that was; the failure's text: why, and what to do.
  Result<MonoTime, Failure> open(const bus::Interruption& interruption, const sensor::Clock& clock);

  /// From when on a slave may get a request; usually a time in the past.
  MonoTime ready_at(std::uint8_t unit) const;

  /// Sends a request and waits for the reply. Sets the request's transaction id. Counts refusals in `sink`, and shows
  /// it each message.
  Reply exchange(decode::modbus::Request request, const bus::ModbusPatience& patience,
                 const bus::Interruption& interruption, const sensor::Clock& clock, sensor::Sink& sink);

  /// How many exchanges are waiting or in progress.
  std::size_t waiting_count() const;

  /// To be called after an interruption was set, so that a caller that waits for its turn notices it.
  void wake_waiters() noexcept;

 private:
  class Turn;

  void close_line() noexcept;
  Reply transact(const decode::modbus::Request& request, const bus::ModbusPatience& patience,
                 const bus::Interruption& interruption, sensor::Sink& sink);
  Trouble fail(bus::Status status, bool received_others, sensor::Sink& sink);
  Trouble refuse(const decode::modbus::RefusedReply& refusal, sensor::Sink& sink);

  const bus::ModbusLine line_;
  const std::string where_;

  mutable std::mutex mutex_;
  std::condition_variable turn_ended_;
  std::deque<std::uint64_t> waiting_;  ///< tickets; the first one has the line
  std::uint64_t last_ticket_ = 0;
  Nanoseconds min_gap_;
  MonoTime free_at_{};                         ///< when the gap after the last exchange has passed
  std::array<MonoTime, 256> unit_ready_at_{};  ///< until when a late reply of that unit may come
  std::optional<MonoTime> open_since_;         ///< empty: the line is not open

  // Of the caller that has the line.
  std::unique_ptr<bus::ModbusConnection> connection_;
  bool is_unsettled_ = true;  ///< a message may still be on the line
  int silent_requests_ = 0;   ///< in a row, to any slave
  std::uint16_t transaction_ = 0;
  std::array<std::uint8_t, decode::modbus::kModbusMaxMessage> buffer_{};
};

/// The bus of that line: the existing one, if another sensor has it, or a new one. A serial port is identified by the
/// device that its name links to. Throws std::runtime_error if it is in use with another baud rate, parity or number
/// of stop bits. Thread-safe: yes.
std::shared_ptr<Bus> shared_modbus_bus(const bus::ModbusLine& line);

}  // namespace yuragi::drivers::modbus
