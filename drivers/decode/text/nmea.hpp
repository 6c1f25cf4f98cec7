#pragma once

#include <optional>
#include <string_view>

#include "drivers/decode/decoded_wind.hpp"
#include "drivers/decode/text_fields.hpp"
#include "engine/wind/station_quantities.hpp"

namespace yuragi::drivers::decode::text {

// The wind in sentences of NMEA 0183, of any talker (WI, II, a number):
//
//   $--MWV,angle,R|T,speed,K|N|M|S,A|V*hh               from the bow, clockwise; R: apparent, T: true wind
//   $--MWD,deg,T,deg,M,kn,N,m/s,M*hh                    from true north, from magnetic north; a pair of number and
//                                                       letter can be absent: $--MWD,deg,T,deg,M,m/s,M*hh
//   $--VWR,0..180,L|R,kn,N,m/s,M,km/h,K*hh              from the bow to port or starboard, apparent
//   $--VWT,...                                          the same, true wind
//   $--MDA,<12 fields of weather>,deg,T,deg,M,kn,N,m/s,M*hh
//   $--XDR,A,deg,D,id,...,S,speed,M|N|K|S,id,...*hh     Vaisala WXT: id is address + 0 least, 1 mean, 2 greatest, each
//                                                       of which can be switched off; of other devices 0 is the reading
//
// hh is the exclusive or of what stands between '$' and '*'. Sources: gpsd www/NMEA.adoc; SignalK nmea0183-signalk
// hooks; Lufft V200A-UMB manual V25 20.5.4 (S is mph); Gill 1405-PS-0019 (status 00 and 60 are good). Devices do
// otherwise (drivers/SOURCES.md S4.6): lower case, a trailing dot, angles of 360 and beyond (of VWR and VWT above 180:
// they are counted on, to the side that is named), lines longer than 82 characters, NUL bytes in front, no status, no
// checksum, other sentences and comments in between.

struct NmeaOptions {
  WhenMissing checksum = WhenMissing::kRefuse;
  WhenMissing status = WhenMissing::kRefuse;  ///< of MWV; a reading that is accepted without one is kUncertain
  int xdr_first_id = 0;                       ///< the address of the device whose XDR is read
};

/// The wind in one line, without its line end, or why there is none: as sentence_of() refuses, then kNotMine (another
/// sentence, or XDR without wind), kMalformed (fields, units or letters that the sentence does not have, or no status
/// where that is refused), kInvalid (by its status, or without a value), kImplausible. One half can be empty; a
/// direction that is impossible, or cannot be read, is left empty if there is a speed beside it. If a sentence has the
/// speed in several units, m/s is taken first. Thread-safe and realtime-safe: yes.
Result<DecodedWind, Refusal> decode_nmea(const NmeaOptions& options, std::string_view line) noexcept;

/// Returns the other quantities in one line, without its time; nullopt if the sentence is invalid, or has none. Values
/// are not checked for their range (wind::plausible_part); only a value that is not a number, or has another unit, is
/// left out.
///
///   MDA   pressure in bar (field 3, B), else in inches of mercury (field 1, I); air temperature (field 5, C); relative
///         humidity (field 9)
///   XDR   C: air temperature (C); P: pressure (B bar, P Pa, H hPa); H: relative humidity (P); V: rain since the
///   counter
///         was set back (M: mm); R: rain rate (M: mm/h)
///
/// Of XDR only transducers whose id is the number `options.xdr_first_id` count: others may be an engine, or the inside
/// of the device. Sources: as of decode_nmea. Thread-safe and realtime-safe: yes.
std::optional<wind::StationQuantities> decode_nmea_quantities(const NmeaOptions& options,
                                                              std::string_view line) noexcept;

}  // namespace yuragi::drivers::decode::text
