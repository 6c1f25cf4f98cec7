#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "drivers/decode/byte_order.hpp"
#include "drivers/decode/decoded_wind.hpp"
#include "drivers/decode/refusal.hpp"
#include "engine/base/result.hpp"
#include "engine/wind/station_quantities.hpp"

namespace yuragi::drivers::decode::hid {

// Oregon Scientific WMR100, WMR100N, WMR88, WMRS200, RMS300, RMS600 (USB 0fde:ca01).
// Source: weewx drivers/wmr100.py, ejeklint/WLoggerDaemon's description of the protocol, and barnybug/wmr100;
// drivers/SOURCES.md S2.1.
//
// An input report of 8 bytes: how many of the next 7 are valid, then those. The valid bytes of all reports are one
// stream of frames, with ff ff between two of them; one ff alone is data.
//
//   frame   0       flags; a high nibble other than 0: the battery is low
//           1       kind: 0x41 rain, 0x42 temperature, 0x44 water, 0x46 pressure, 0x47 UV, 0x48 wind, 0x60 clock
//           last 2  sum of all bytes before, low byte first
//   wind    2       low nibble: direction, points of 22.5 degrees
//   (11     4       gust, low 8 bits, 0.1 m/s
//   bytes)  5       low nibble: gust, high 4 bits; high nibble: average, low 4 bits
//           6       average, high 8 bits, 0.1 m/s
//           7, 8    wind chill
//   rain    4, 5    of the last hour   6, 7   of 24 hours   8, 9   since it was reset: 0.01 inch, low byte first
//   (17)    2, 3    a rate, of which sources differ: not read
//   temp.   2       low nibble: channel: 0 the console's own, 1 outdoors (weewx's map), 2 to 8 further sensors
//   (12)    3, 4    0.1 degrees Celsius, low byte first; the top bit is the sign       5   humidity, %
//   press.  2, 3    at the station, hPa, 12 bits, low byte first; the high nibble of 3 is a forecast
//   (8)     4, 5    the same reduced to sea level

/// No frame is longer (rain).
inline constexpr std::size_t kWmr100LongestFrame = 17;

/// The report that starts the console's sending (without report id).
inline constexpr std::array<std::uint8_t, 8> kWmr100Start = {0x20, 0x00, 0x08, 0x01, 0x00, 0x00, 0x00, 0x00};

/// The valid bytes of one input report, which can be empty. A count beyond the report is clamped to it. It points into
/// `report`. Thread-safe and realtime-safe: yes.
ByteSpan wmr100_report_bytes(ByteSpan report) noexcept;

/// The position in the stream; its owner keeps one for each time that the device was opened, and does not use its
/// members.
struct Wmr100Stream {
  std::array<std::uint8_t, kWmr100LongestFrame + 1> frame{};  ///< and the first ff after it
  std::size_t size = 0;
  bool is_skipping = false;    ///< the rest of this frame is ignored
  bool was_ff = false;         ///< the last byte was ff
  std::size_t ended_size = 0;  ///< of the frame that the last byte ended
};

/// Takes the stream's next byte. If that ends a frame, returns its wind, or why it has none (the order of
/// decode_wmr100_frame(), and kMalformed for a frame without end); otherwise nullopt. A wind frame ends with its
/// eleventh byte, so that it need not wait for the next sensor's. After any damage the frame after the next ff ff is
/// read. Memory is bounded. Realtime-safe: yes; thread-safe: for distinct streams.
std::optional<Result<DecodedWind, Refusal>> take_wmr100_byte(Wmr100Stream& stream, std::uint8_t byte) noexcept;

/// Ends the stream. Returns the wind of its last frame if that was still waiting for the ff ff behind it; otherwise
/// nullopt.
std::optional<Result<DecodedWind, Refusal>> finish_wmr100(Wmr100Stream& stream) noexcept;

/// Returns the frame whose wind or refusal take_wmr100_byte() or finish_wmr100() has just returned, without its ff ff;
/// empty if they returned nullopt. It points into `stream`, and is valid until the next byte. Thread-safe: for distinct
/// streams; realtime-safe: yes.
ByteSpan ended_wmr100_frame(const Wmr100Stream& stream) noexcept;

/// The wind of one frame without its ff ff, or the first thing that is wrong: kTooShort, kBadChecksum, kNotMine
/// (another sensor's), kMalformed (longer than a wind frame), kImplausible. Consoles sometimes send a gust below the
/// average, which cannot be: it is left out. Thread-safe and realtime-safe: yes.
Result<DecodedWind, Refusal> decode_wmr100_frame(ByteSpan frame) noexcept;

/// Returns the other quantities in such a frame, without its time: temperature and humidity outdoors, pressure at the
/// station, or rain; nullopt if it is damaged, has a wrong length for its kind, or is another sensor's. Values are not
/// checked for their range (wind::plausible_part). Thread-safe and realtime-safe: yes.
std::optional<wind::StationQuantities> decode_wmr100_quantities(ByteSpan frame) noexcept;

}  // namespace yuragi::drivers::decode::hid
