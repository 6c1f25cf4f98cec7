#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "drivers/decode/byte_order.hpp"
#include "drivers/decode/refusal.hpp"
#include "engine/base/result.hpp"

namespace yuragi::drivers::decode::usb {

// LabJack U3 (USB 0cd5:0003): a counter for a cup, an ADC of 16 bits for a vane.
// Source: labjack/exodriver examples/U3/u3.{h,c} (ehFeedback, ehConfigIO, getCalibrationInfo, checksums, nominal
// calibration) and liblabjackusb/labjackusb.c.
//
// Commands go out on bulk endpoint 0x01, replies come on 0x82. Both are framed alike:
//
//   0      sum of bytes 1 to 5, its carries added in (twice)      3      the command
//   1      0xF8                                                   4, 5   sum of all bytes from 6, low byte first
//   2      words (2 bytes) from byte 6                            6...   data, filled up to a whole word
//   b8 b8  the device's whole reply to a command with a wrong sum
//
//   command        data out, from 6                            data in, from 6
//   00 feedback    echo; 01, channel, 1f (AIN against          error, which part, echo; in the command's order: AIN
//                  ground); 36, 00 (Counter0) or 37, 00        2 bytes, counter 4 bytes, low byte first
//                  (Counter1)
//   08 ConfigU3    20 bytes of 0 change nothing                error, ...; at 15 the serial number (4 bytes), at 37
//                                                              the version: bits 1 and 4 are both set in a U3-HV
//   0B ConfigIO    mask (1: counters, 4: FIO, 8: EIO), 0,      error, 0, the same four as they are now
//                  pin offset << 4 | counters, DAC1, FIO, EIO
//   2D ReadMem     0, block                                    error, 0, four numbers of 8 bytes: 32 bits before
//                                                              the point, 32 behind it, low byte first

/// A command: `bytes` up to `size`.
struct LabjackCommand {
  std::array<std::uint8_t, 26> bytes{};
  std::size_t size = 0;

  ByteSpan span() const noexcept { return ByteSpan(bytes).first(size); }
};

struct LabjackRefusal {
  Refusal why = Refusal::kMalformed;
  std::uint8_t error = 0;  ///< the device's error code, if `why` is kException; 0: it found our sum wrong
};

// All functions: thread-safe and realtime-safe. A reply is refused for the first thing that is wrong with it: kTooShort
// (no header, or it ends before its own length), kMalformed (not a frame, or longer than its length), kBadChecksum,
// kNotMine (another command or echo), kException (an error code of the device), kMalformed (another number of values).

/// Counter 0 or 1 alone, on FIO4 (also on the U3-HV), and FIO0 to FIO3 analogue: what LabjackRequest relies on. The
/// counter begins at 0.
LabjackCommand encode_labjack_configuration(std::uint8_t counter) noexcept;
/// kInvalid if the device did not do what the command requested.
Result<void, LabjackRefusal> decode_labjack_configuration(std::uint8_t counter, ByteSpan reply) noexcept;

/// The parts of a feedback command, in this order.
struct LabjackRequest {
  std::uint8_t echo = 0;
  std::optional<std::uint8_t> analog_channel = 0;      ///< AIN against ground
  std::optional<std::uint8_t> reference_channel = {};  ///< another one
  std::optional<std::uint8_t> counter = 0;             ///< 0 or 1; not reset by it
};

/// The values of a reply, those that were requested. advance_cup() and vane_direction_deg() convert them to wind.
struct LabjackReply {
  std::optional<std::uint16_t> analog;
  std::optional<std::uint16_t> reference;
  std::optional<std::uint32_t> count;
};
LabjackCommand encode_labjack_feedback(const LabjackRequest& request) noexcept;
Result<LabjackReply, LabjackRefusal> decode_labjack(const LabjackRequest& request, ByteSpan reply) noexcept;

/// How an analogue input is built.
enum class LabjackInput : std::uint8_t {
  kLowVoltage,   ///< 0 to 2.44 V: FIO and EIO, and every input of the U3-LV
  kHighVoltage,  ///< -10 to 10 V: AIN0 to AIN3 of the U3-HV
};

/// Which device it is.
struct LabjackIdentity {
  std::uint32_t serial = 0;
  LabjackInput input = LabjackInput::kLowVoltage;  ///< how AIN0 to AIN3 are built
};
LabjackCommand encode_labjack_identity() noexcept;
Result<LabjackIdentity, LabjackRefusal> decode_labjack_identity(ByteSpan reply) noexcept;

/// One block of the calibration memory. Low voltage inputs: block 0, slope and offset. AIN0 to AIN3 of the U3-HV: their
/// slopes in block 3, their offsets in block 4.
LabjackCommand encode_labjack_memory(std::uint8_t block) noexcept;
Result<std::array<double, 4>, LabjackRefusal> decode_labjack_memory(ByteSpan reply) noexcept;

/// From steps to volts.
struct LabjackCalibration {
  double volts_per_step = 0.0;
  double offset_v = 0.0;

  double volts(std::uint16_t analog) const noexcept { return volts_per_step * analog + offset_v; }
};

/// The maker's limits for any device.
LabjackCalibration nominal_labjack_calibration(LabjackInput input) noexcept;
/// Returns true if such an input can have this error; otherwise the memory contains something else.
bool is_believable(const LabjackCalibration& calibration, LabjackInput input) noexcept;

}  // namespace yuragi::drivers::decode::usb
