#pragma once

#include <cstdint>

#include "drivers/decode/byte_order.hpp"
#include "drivers/decode/refusal.hpp"
#include "engine/base/result.hpp"

namespace yuragi::drivers::decode::usb {

// Measurement Computing USB-1208FS-Plus (USB 09db:00e8): a counter for a cup, an ADC of 12 bits for a vane.
// Source: wjasper/Linux_Drivers USB/mcc-libusb/usb-1208FS-Plus.{h,c} (usbCounter, usbAIn, usbReadCalMemory, volts) and
// USB/python/usb_1208FS_Plus.py ("Range for Single Ended is +/- 10V only"; UP_5V is a range of the analogue outputs).
//
// Everything is a vendor's control transfer to the device:
//
//   counter       C0 20, wValue 0, wIndex 0           4 bytes: events since the last reset, low byte first
//   reset         40 20, wValue 0, wIndex 0           nothing
//   ADC           C0 10, wValue channel (0 to 7),     2 bytes: 0 to 4095, low byte first; the input against ground,
//                 wIndex 1                            -10 to 10 V
//   calibration   C0 30, wValue 0x100 + 8 * channel   8 bytes: slope and intercept of that input, 32-bit floats, low
//                                                     byte first: right code = code * slope + intercept

/// A vendor's control transfer, as libusb_control_transfer() wants its arguments.
struct Mcc1208Transfer {
  std::uint8_t request_type = 0;
  std::uint8_t request = 0;
  std::uint16_t value = 0;
  std::uint16_t index = 0;
  std::uint16_t length = 0;

  bool operator==(const Mcc1208Transfer&) const = default;
};

inline constexpr std::uint8_t kMcc1208Inputs = 8;
inline constexpr Mcc1208Transfer kMcc1208ReadCounter = {0xC0, 0x20, 0, 0, 4};

/// Asks for the value of input `channel`, or for its calibration.
constexpr Mcc1208Transfer mcc1208_read_analog(std::uint8_t channel) noexcept {
  return {0xC0, 0x10, channel, 1, 2};
}
constexpr Mcc1208Transfer mcc1208_read_calibration(std::uint8_t channel) noexcept {
  return {0xC0, 0x30, static_cast<std::uint16_t>(0x100 + 8 * channel), 0, 8};
}

/// The correction of an input's codes; the default corrects nothing.
struct Mcc1208Calibration {
  double slope = 1.0;
  double intercept_steps = 0.0;
};

// The replies to these, by their length: kTooShort, kMalformed (longer, or more than 12 bits). advance_cup() and
// vane_direction_deg() convert the values to wind. Thread-safe and realtime-safe: yes.

Result<std::uint32_t, Refusal> decode_mcc1208_count(ByteSpan reply) noexcept;
Result<std::uint16_t, Refusal> decode_mcc1208_analog(ByteSpan reply) noexcept;
/// kInvalid if no input can have this error: the memory was erased, or never written.
Result<Mcc1208Calibration, Refusal> decode_mcc1208_calibration(ByteSpan reply) noexcept;

/// The voltage of an `analog` value.
double mcc1208_volts(std::uint16_t analog, const Mcc1208Calibration& calibration) noexcept;

}  // namespace yuragi::drivers::decode::usb
