#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "drivers/decode/decoded_wind.hpp"
#include "drivers/decode/text_fields.hpp"
#include "engine/wind/station_quantities.hpp"

namespace yuragi::drivers::decode::text {

// Vaisala WXT510 to WXT536 and WMT52 in their ASCII protocol, automatic or polled ("0R1" CR LF):
//
//   0R1,Dn=236D,Dm=283D,Dx=031D,Sn=0.0M,Sm=1.0M,Sx=2.2M        wind: direction and speed, least, mean and greatest
//   0R2,Ta=23.6C,Ua=14.2P,Pa=1026.6H                           air temperature, relative humidity, pressure
//   0R3,Rc=0.0M,Rd=0s,Ri=0.0M,...                              rain: amount, duration, intensity; hail
//   0R0,Dm=051D,Sm=0.1M,Ta=27.9C,...                           of all, as the device is set
//   0r1,Dn=...,Sx=2.2Mxxx                                      a small r: with a checksum
//
// The first character is the device's address. A unit stands behind each number, and '#' in its place if the value is
// not valid: speed M m/s, K km/h, S mph, N knots; temperature C, F; pressure H hPa, P Pa, B bar, M mmHg, I inHg; rain M
// mm and mm/h, I inches and in/h. xxx is a CRC-16 (polynomial 0xA001, begun with 0) in three characters of six bits
// each above 0x40. Source: Vaisala WXT530 user's guide M211840EN, 7.2 and appendix C. Its example of a wind message
// with a checksum ("LFj") is not what its own algorithm gives; its commands ("0r2Gje") and the example in the WMT700
// user's guide M211095EN ("CAH") are.

struct WxtOptions {
  WhenMissing checksum = WhenMissing::kRefuse;  ///< of a message with a large R, which has none
};

/// The mean wind in one line and its greatest speed as the gust, or why there is none: kTooShort, kNotMine (no data
/// message of these devices, or one without wind), kBadChecksum (wrong, or missing if that is refused), kMalformed (a
/// field that is not "Xx=number unit", or comes twice), kInvalid (no mean speed: it is marked '#', or not sent),
/// kImplausible. Thread-safe and realtime-safe: yes.
Result<DecodedWind, Refusal> decode_wxt(const WxtOptions& options, std::string_view line) noexcept;

/// Returns the other quantities in such a line, without its time; nullopt if decode_wxt() would refuse it, except as
/// kNotMine, kInvalid or kImplausible. Values are not checked for their range (wind::plausible_part). Thread-safe and
/// realtime-safe: yes.
std::optional<wind::StationQuantities> decode_wxt_quantities(const WxtOptions& options, std::string_view line) noexcept;

/// Returns true if the line looks like a data message of these devices: "0R1,Dn=...". Thread-safe and realtime-safe:
/// yes.
bool looks_like_wxt(std::string_view line) noexcept;

/// The request for a wind message with a checksum from the device of that address: "0r1Goe" CR LF.
std::string wxt_wind_request(char address);

}  // namespace yuragi::drivers::decode::text
