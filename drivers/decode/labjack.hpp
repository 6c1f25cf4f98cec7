#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "drivers/decode/byte_order.hpp"
#include "drivers/decode/refusal.hpp"
#include "engine/base/result.hpp"

namespace yuragi {

// LabJack U3 (USB 0cd5:0003): a counter for a cup, an ADC of 16 bits for a vane.
// Source: ../shared/sensors.md 3, and labjack/exodriver examples/U3/u3.c (ehFeedback, checksums, nominal calibration).
//
// Commands go out on bulk endpoint 0x01, replies come on 0x82. Both are framed alike:
//
//   0      sum of bytes 1 to 5, its carries added in (twice)      3      the command: 0x00 feedback, 0x0B configuration
//   1      0xF8                                                   4, 5   sum of all bytes from 6, low byte first
//   2      words (2 bytes) from byte 6                            6...   data, filled up to a whole word
//   feedback command   6    echo      then 01, channel, 31 (AIN against ground); 36, 0 (Counter0, not reset)
//   feedback reply     6    error     7   which part of the command failed      8   echo
//                      9    in the command's order: AIN 2 bytes, counter 4 bytes, low byte first
//   b8 b8              the device's whole reply to a command with a wrong sum

/// What a feedback command asks for, the analogue input first.
struct LabjackRequest {
  std::uint8_t echo = 0;
  std::optional<std::uint8_t> analog_channel = 0;  ///< AIN against ground
  bool wants_counter = true;                       ///< Counter0, which is not reset by it
};

/// Counter0 on FIO4, FIO0 to FIO3 analogue: what LabjackRequest relies on (also on the U3-HV).
inline constexpr std::array<std::uint8_t, 12> kLabjackConfiguration = {0x67, 0xF8, 0x03, 0x0B, 0x60, 0x00,
                                                                       0x0D, 0x00, 0x44, 0x00, 0x0F, 0x00};

/// A feedback command: `bytes` up to `size`.
struct LabjackCommand {
  std::array<std::uint8_t, 12> bytes{};
  std::size_t size = 0;

  ByteSpan span() const noexcept { return ByteSpan(bytes).first(size); }
};
LabjackCommand encode_labjack_feedback(const LabjackRequest& request) noexcept;

/// What a reply holds: as much as was asked for. What wind it means, advance_cup() and vane_direction_deg() say.
struct LabjackReply {
  std::optional<std::uint16_t> analog;
  std::optional<std::uint32_t> count;
};

struct LabjackRefusal {
  Refusal why = Refusal::kMalformed;
  std::uint8_t error = 0;  ///< the device's error code, where `why` is kException; 0: it found our sum wrong
};

/// The reply to `request`, or the first thing that is wrong with it: kTooShort (no header, or it ends before its own
/// length), kMalformed (not a frame, or longer than it says), kBadChecksum, kNotMine (another command or echo),
/// kException (the device says what), kMalformed (another number of values). Thread-safe and realtime-safe: yes.
Result<LabjackReply, LabjackRefusal> decode_labjack(const LabjackRequest& request, ByteSpan reply) noexcept;

/// How an analogue input is built.
enum class LabjackInput : std::uint8_t {
  kLowVoltage,   ///< 0 to 2.44 V: FIO and EIO, and every input of the U3-LV
  kHighVoltage,  ///< -10 to 10 V: AIN0 to AIN3 of the U3-HV
};

/// The voltage of an `analog` value, by the maker's nominal calibration.
double labjack_volts(std::uint16_t analog, LabjackInput input) noexcept;

}  // namespace yuragi
