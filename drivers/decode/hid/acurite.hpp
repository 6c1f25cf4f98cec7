#pragma once

#include <cstddef>
#include <optional>

#include "drivers/decode/byte_order.hpp"
#include "drivers/decode/decoded_wind.hpp"
#include "drivers/decode/refusal.hpp"
#include "engine/base/result.hpp"
#include "engine/wind/station_quantities.hpp"

namespace yuragi::drivers::decode::hid {

// AcuRite 01025, 01035, 01036, 02032, 02064 (USB 24c0:0003).
// Source: weewx drivers/acurite.py and issue 39; wxforum topic 27244 (speed); drivers/SOURCES.md S2.4.
//
// The console sends only on request: input report 1 is requested every 18 s. Its contents alternate, so that a
// direction comes every 36 s.
//
//   0   1, the report's id
//   1   high nibble: channel; low nibble with byte 2: the sensor's id. xF here and ff in byte 3: no sensor
//   3   high nibble: battery, 7 is well; low nibble: 1 wind, direction, rain; 8 wind, temperature, humidity
//   4   low 5 bits: speed n, high bits      5   bits 4 to 6: speed n, low bits; low nibble in 1: direction's index
//   6   in 1: low 6 bits, tips of the rain gauge, high bits; in 8: low 7 bits, temperature, low bits (high bits: low
//       nibble of 5)
//   7   low 7 bits, in 1: tips, low bits; in 8: humidity, %
//   8   low nibble: link, 0 to 3; at 0 all numbers are old
//   9   00 or ff
//
// Speed is 0 at n = 0, else 0.8278 n + 1 km/h. A tip is 0.01 inch. Temperature is n / 18 - 40 degrees Celsius. The
// pressure would be in report 2, which is not requested: its meaning depends on the console's sensor and on constants
// in it, and according to weewx it is often far from the pressure at the station.

inline constexpr std::size_t kAcuriteReport1 = 10;

/// The wind of report 1 with its id in front, or the first thing that is wrong: kTooShort, kNotMine (another report),
/// kMalformed (too long, or marks that no report has: a console in a bad state), kInvalid (no sensor, or old numbers).
/// A report without a direction leaves it empty: it is not kept from the one before. Thread-safe and realtime-safe:
/// yes.
Result<DecodedWind, Refusal> decode_acurite(ByteSpan report) noexcept;

/// Returns the other quantities in such a report, without its time: rain beside a direction, otherwise temperature and
/// humidity; nullopt if decode_acurite() refuses it. Values are not checked for their range (wind::plausible_part).
/// Thread-safe and realtime-safe: yes.
std::optional<wind::StationQuantities> decode_acurite_quantities(ByteSpan report) noexcept;

}  // namespace yuragi::drivers::decode::hid
