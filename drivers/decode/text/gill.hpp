#pragma once

#include <optional>
#include <string_view>

#include "drivers/decode/decoded_wind.hpp"
#include "drivers/decode/text_fields.hpp"
#include "engine/wind/station_quantities.hpp"

namespace yuragi::drivers::decode::text {

// Gill's own ASCII formats (WindSonic, WindObserver, WindMaster, MaxiMet):
//
//   <STX>Q,ddd,sss.ss,M,nn,<ETX>cc             polar: node, direction, speed, unit, status
//   <STX>Q,+uuu.uu,-vvv.vv,M,nn,<ETX>cc        UV: the wind blows toward north (+U) and toward west (+V)
//   <STX>Q,ddd,sss.ss,M,...,nn,<ETX>cc         WindObserver: speed of sound and temperature before the status
//   <STX>Q,+uuu.uu,-vvv.vv,+www.ww,M,...,nn,...,<ETX>cc    WindMaster, also with ddd.d,sss.sss for U and V: W is the
//                                              vertical wind; the speed of sound and the temperature, where they are
//                                              configured, before the status, analogue inputs behind it
//   <STX>Q,ddd,sss.ss,ddd,sss.ss,...,<ETX>cc   MaxiMet: no unit in the message; the status is four hexadecimal digits
//
// cc is the exclusive or of what stands between STX and ETX. Units: M m/s, N knots, P mph, K km/h, F feet a minute.
// Status 00 (and 60, A) is good; 01, 02, 04 (an axis or both have failed), 08, 09 (memory) and all others are not, and
// the fields are then empty or 999. Below 0.05 m/s the direction is empty, or, in fixed-field mode, still the last one.
// Sources: Gill WindSonic manual 1405-PS-0019 issue 28 and 30, chapters 9, 11.5 and figure 5 (six of the checksums that
// it prints are wrong); WindObserver 65 manual 1390-PS-0039 figure 4. That +V is toward west follows from the manual's
// figure (V runs east to west, 90 degrees anticlockwise from U); WindMaster manual 1561-PS-0001 issue 11, 7.1 to 7.4
// and its lines on page 56. That +W is upward, along the shaft of an instrument that stands, is [unconfirmed]: its
// figure.

struct GillOptions {
  WhenMissing checksum = WhenMissing::kRefuse;
  WhenMissing status = WhenMissing::kRefuse;  ///< not of MaxiMet, which leaves it out as it is configured
  std::optional<char> node;                   ///< take only this one's messages
  /// In a slower wind than this the device does not measure the direction (its setting K), even if the field has one.
  double least_speed_with_direction_m_s = 0.05;
};

/// The wind in one line, with or without its STX and line end; or an NMEA sentence, as the device sends it in modes M5
/// to M16. Refusals, in this order: kTooShort (it ends before its checksum), kBadChecksum, kNotMine (not this format,
/// or another node), kMalformed, kInvalid (by its status, or without a value), kImplausible. The direction is clockwise
/// from the device's north mark. Thread-safe and realtime-safe: yes.
Result<DecodedWind, Refusal> decode_gill(const GillOptions& options, std::string_view line) noexcept;

/// Returns the vertical wind of a WindMaster's line, without its time; nullopt for other lines, and if decode_gill()
/// refuses the line for another reason than the values of its horizontal wind. Not checked for its range
/// (wind::plausible_part). Thread-safe and realtime-safe: yes.
std::optional<wind::StationQuantities> decode_gill_quantities(const GillOptions& options,
                                                              std::string_view line) noexcept;

}  // namespace yuragi::drivers::decode::text
