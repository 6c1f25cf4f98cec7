#pragma once

#include <algorithm>
#include <cstdint>
#include <deque>
#include <functional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "drivers/bus/byte_port.hpp"
#include "tests/support/manual_clock.hpp"

namespace yuragi {

/// The far end of a port without a wire: the test says what comes, and sees what is sent.
struct FarEnd {
  struct Message {
    drivers::bus::ByteStatus status = drivers::bus::ByteStatus::kBytes;
    std::string bytes;
    bool is_datagram = false;
  };

  std::deque<Message> incoming;
  std::vector<std::string> written;
  bool can_open = true;
  bool can_write = true;
  int opened = 0;
  int closed = 0;
  /// Called with each request; incoming() what it likes.
  std::function<void(const std::string& request)> on_request;

  void send(std::string_view text) { incoming.push_back({drivers::bus::ByteStatus::kBytes, std::string(text), false}); }
};

/// Waiting for nothing moves the clock.
class ScriptedPort final : public drivers::bus::BytePort {
 public:
  ScriptedPort(FarEnd& far_end, ManualClock& clock) : far_end_(far_end), clock_(clock) {}

  Result<void, Failure> open() override {
    if (!far_end_.can_open) return Failure{"cannot open the script: try again"};
    ++far_end_.opened;
    return {};
  }
  void close() noexcept override { ++far_end_.closed; }

  drivers::bus::ByteArrival read(std::span<std::uint8_t> buffer, Nanoseconds timeout) override {
    if (far_end_.incoming.empty()) {
      clock_.advance(timeout);
      return {};
    }
    FarEnd::Message& message = far_end_.incoming.front();
    const std::size_t size = std::min(buffer.size(), message.bytes.size());
    std::copy_n(message.bytes.begin(), size, buffer.begin());
    const drivers::bus::ByteArrival arrival = {message.status, size, message.is_datagram};
    message.bytes.erase(0, size);
    if (message.bytes.empty()) far_end_.incoming.pop_front();
    return arrival;
  }

  bool write(std::span<const std::uint8_t> bytes) override {
    if (!far_end_.can_write) return false;
    far_end_.written.emplace_back(bytes.begin(), bytes.end());
    if (far_end_.on_request) far_end_.on_request(far_end_.written.back());
    return true;
  }
  void interrupt() noexcept override {
    far_end_.incoming.push_front({drivers::bus::ByteStatus::kInterrupted, "", false});
  }

 private:
  FarEnd& far_end_;
  ManualClock& clock_;
};

}  // namespace yuragi
