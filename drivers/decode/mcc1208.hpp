#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "drivers/decode/byte_order.hpp"
#include "drivers/decode/refusal.hpp"
#include "engine/base/result.hpp"

namespace yuragi {

// Measurement Computing USB-1208FS-Plus (USB 09db:00e8): a counter for a cup, an ADC of 12 bits for a vane.
// Source: ../shared/sensors.md 3, and wjasper/Linux_Drivers USB/mcc-libusb/usb-1208FS-Plus.c (usbCounter, usbAIn,
// volts).
//
// Everything is a vendor's control transfer to the device:
//
//   counter   C0 20, wValue 0, wIndex 0              4 bytes: events since the last reset, low byte first
//   reset     40 20, wValue 0, wIndex 0              nothing
//   ADC       C0 10, wValue mode << 8 | channel,     2 bytes: 0 to 4095, low byte first
//             wIndex range

/// The analogue inputs' ranges, as wIndex has them: bipolar ones on two inputs against each other (mode 1), and
/// kBipolar10V and kUnipolar5V on one against ground (mode 0).
enum class Mcc1208Range : std::uint8_t {
  kBipolar20V,
  kBipolar10V,
  kBipolar5V,
  kBipolar4V,
  kBipolar2_5V,
  kBipolar2V,
  kBipolar1_25V,
  kBipolar1V,
  kUnipolar5V,
};

/// A vendor's control transfer, as libusb_control_transfer() wants its arguments.
struct Mcc1208Transfer {
  std::uint8_t request_type = 0;
  std::uint8_t request = 0;
  std::uint16_t value = 0;
  std::uint16_t index = 0;
  std::uint16_t length = 0;

  bool operator==(const Mcc1208Transfer&) const = default;
};

inline constexpr Mcc1208Transfer kMcc1208ReadCounter = {0xC0, 0x20, 0, 0, 4};
inline constexpr Mcc1208Transfer kMcc1208ResetCounter = {0x40, 0x20, 0, 0, 0};

/// Asks for `channel` (0 to 7) against ground, or against its neighbour.
Mcc1208Transfer mcc1208_read_analog(std::uint8_t channel, bool is_differential, Mcc1208Range range) noexcept;

/// What a reply holds: the one or the other. What wind it means, advance_cup() and vane_direction_deg() say.
struct Mcc1208Reply {
  std::optional<std::uint32_t> count;
  std::optional<std::uint16_t> analog;  ///< 0 to 4095
};

/// A reply by its length: kTooShort (neither), kMalformed (longer, or more than 12 bits). Thread-safe and
/// realtime-safe: yes.
Result<Mcc1208Reply, Refusal> decode_mcc1208(ByteSpan reply) noexcept;

/// The voltage of an uncalibrated `analog` value.
double mcc1208_volts(std::uint16_t analog, Mcc1208Range range) noexcept;

}  // namespace yuragi
