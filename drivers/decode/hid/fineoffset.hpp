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

// Fine Offset WH1080, WH1090, WH2080, WH3080 and their many names (USB 1941:8021).
// Source: weewx drivers/fousb.py and pywws weatherstation.py; drivers/SOURCES.md S2.3.
//
// The console's memory of 64 KiB is read in blocks of 32 bytes: a fixed block at 0, then a ring of records, of which
// the fixed block has the address of the current one.
//
//   request       a1, address high, low, 20, and the same four again; 32 bytes come in four input reports
//   fixed block   0, 1     55 aa, or another mark that consoles have been seen with
//                 16       minutes between two records
//                 27, 28   records in the ring, low byte first
//                 30, 31   address of the current record, low byte first
//   record        4        humidity outside, %; 0xff: none
//   (16 bytes,    5, 6     temperature outside, 0.1 degrees Celsius, low byte first; the top bit is the sign; ff ff:
//   none WH3080: 20)   7, 8     pressure at the console, 0.1 hPa, low byte first; ff ff: none
//                 9        average, low 8 bits     10   gust, low 8 bits
//                 11       low nibble: average's high 4 bits; high nibble: gust's. Both 0.1 m/s; 0xfff: none
//                 12       direction, points of 22.5 degrees; bit 7: none
//                 13, 14   rain since the counter was 0, 0.3 mm, low byte first
//                 15       bit 6: no contact with the sensors, the values are old
//
// A record in the ring and the current one are alike; the console writes the latter every 48 s.

inline constexpr std::size_t kFineOffsetBlock = 32;             ///< bytes of one read
inline constexpr std::uint16_t kFineOffsetFirstRecord = 0x100;  ///< where the ring begins; it ends with the memory

/// The length of a console's records.
enum class FineOffsetModel : std::uint8_t { kWh1080 = 16, kWh3080 = 20 };

/// The fields of the fixed block that are used.
struct FineOffsetFixedBlock {
  std::uint8_t read_period_min = 0;
  std::uint16_t record_count = 0;
  std::uint16_t current_position = 0;  ///< address of the current record
};

/// The 8 bytes that request the 32 bytes at `address`; hidapi needs a report id 0 before them.
std::array<std::uint8_t, 8> encode_fineoffset_read(std::uint16_t address) noexcept;

/// The fixed block's first 32 bytes (or more of it), or kTooShort, or kMalformed (another mark), or kImplausible (a
/// position outside the ring or between two records). Thread-safe and realtime-safe: yes.
Result<FineOffsetFixedBlock, Refusal> decode_fineoffset_fixed_block(ByteSpan block, FineOffsetModel model) noexcept;

/// The wind of one record (16 bytes, 20, or the whole block of 32 that begins with it), or the first thing that is
/// wrong: kTooShort, kMalformed (longer, or memory that was never written), kInvalid (no contact, or no value),
/// kImplausible. A direction that is no point of the compass is left out, and the reading uncertain. Thread-safe and
/// realtime-safe: yes.
Result<DecodedWind, Refusal> decode_fineoffset_record(ByteSpan record) noexcept;

/// Returns the other quantities in such a record, without its time; nullopt if decode_fineoffset_record() would refuse
/// it as kTooShort or kMalformed. Without contact to the outdoor sensors it is only the pressure. Values are not
/// checked for their range (wind::plausible_part). Thread-safe and realtime-safe: yes.
std::optional<wind::StationQuantities> decode_fineoffset_quantities(ByteSpan record) noexcept;

}  // namespace yuragi::drivers::decode::hid
