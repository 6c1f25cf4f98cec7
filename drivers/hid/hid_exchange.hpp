#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>

#include "drivers/bus/hid_device.hpp"
#include "drivers/decode/byte_order.hpp"
#include "drivers/decode/decoded_wind.hpp"
#include "drivers/sensor/sensor.hpp"
#include "engine/wind/station_quantities.hpp"

namespace yuragi::drivers::hid {

/// The result of a read.
struct Message {
  bus::HidStatus status = bus::HidStatus::kSilence;
  decode::ByteSpan bytes;  ///< for kReport; valid until the next message
};

/// The exchange with a station during one poll(): device, clock and sink. Shows every message to the sink. Owns
/// nothing. Thread-safe: no.
class Exchange {
 public:
  Exchange(bus::HidDevice& device, const sensor::Clock& clock, sensor::Sink& sink)
      : device_(device), clock_(clock), sink_(sink) {}

  MonoTime now() const noexcept { return clock_.now().mono; }

  Message read(Nanoseconds timeout);
  /// Sends the bytes as an output report without a number.
  bool send(std::span<const std::uint8_t> bytes);
  Message get_input_report(std::uint8_t id, std::size_t size);

  /// Discards reports that came before the request: late replies. Returns false if the device is disconnected.
  bool discard_waiting();

  void refuse(decode::Refusal why) { sink_.refused(why); }
  /// Passes on the station's other quantities, as of now; does nothing if there are none.
  void publish(std::optional<wind::StationQuantities> quantities);
  /// Publishes the wind as of now. Returns false, and counts a refusal, if it has no speed.
  bool publish(const decode::DecodedWind& wind);

 private:
  static constexpr std::size_t kMaxReport = 64;

  bus::HidDevice& device_;
  const sensor::Clock& clock_;
  sensor::Sink& sink_;
  std::array<std::uint8_t, kMaxReport + 1> buffer_{};
};

}  // namespace yuragi::drivers::hid
