#pragma once

#include <algorithm>
#include <deque>
#include <functional>
#include <vector>

#include "drivers/bus/modbus_connection.hpp"

namespace yuragi {

/// A line without a device: the test says what comes of each request.
struct FakeLine {
  bool can_open = true;
  std::vector<drivers::decode::modbus::Request> requests;
  int opened = 0;
  int settled = 0;
  /// What a request brings, message after message; silence when they are used up.
  std::function<std::deque<drivers::bus::Status>(const drivers::decode::modbus::Request&)> statuses;
  std::function<std::vector<std::uint8_t>(const drivers::decode::modbus::Request&)> message;
};

/// A whole answer to `request`, on TCP.
inline std::vector<std::uint8_t> reply_with(const drivers::decode::modbus::Request& request,
                                            const std::vector<std::uint16_t>& registers) {
  std::vector<std::uint8_t> bytes = {static_cast<std::uint8_t>(request.transaction >> 8U),
                                     static_cast<std::uint8_t>(request.transaction & 0xFFU),
                                     0,
                                     0,
                                     0,
                                     static_cast<std::uint8_t>(3 + 2 * registers.size()),
                                     request.unit,
                                     request.function,
                                     static_cast<std::uint8_t>(2 * registers.size())};
  for (const std::uint16_t value : registers) {
    bytes.push_back(static_cast<std::uint8_t>(value >> 8U));
    bytes.push_back(static_cast<std::uint8_t>(value & 0xFFU));
  }
  return bytes;
}

/// The connection to it.
class FakeConnection final : public drivers::bus::ModbusConnection {
 public:
  explicit FakeConnection(FakeLine& line) : line_(line) {}

  Result<void, Failure> open(const drivers::bus::Interruption&) override {
    ++line_.opened;
    if (!line_.can_open) return Failure{"cannot open the fake"};
    is_open_ = true;
    return {};
  }
  bool is_open() const noexcept override { return is_open_; }
  void close() noexcept override { is_open_ = false; }
  std::size_t settle(std::span<std::uint8_t, drivers::decode::modbus::kModbusMaxMessage>,
                     const drivers::bus::ModbusPatience&, const drivers::bus::Interruption&) override {
    ++line_.settled;
    return 0;
  }
  bool send(const drivers::decode::modbus::Request& request, const drivers::bus::ModbusPatience&) override {
    line_.requests.push_back(request);
    coming_ = line_.statuses(request);
    return true;
  }
  drivers::bus::Message receive(std::span<std::uint8_t, drivers::decode::modbus::kModbusMaxMessage> buffer,
                                const drivers::bus::Interruption& interruption) override {
    if (interruption.is_set()) return {drivers::bus::Status::kInterrupted};
    if (coming_.empty()) return {drivers::bus::Status::kSilence};
    const drivers::bus::Status status = coming_.front();
    coming_.pop_front();
    if (status != drivers::bus::Status::kMessage) return {status};
    const auto bytes = line_.message(line_.requests.back());
    std::ranges::copy(bytes, buffer.begin());
    return {status, bytes.size()};
  }

 private:
  FakeLine& line_;
  bool is_open_ = false;
  std::deque<drivers::bus::Status> coming_;
};

}  // namespace yuragi
