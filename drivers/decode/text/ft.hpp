#pragma once

#include <string_view>

#include "drivers/decode/decoded_wind.hpp"
#include "drivers/decode/text_fields.hpp"

namespace yuragi::drivers::decode::text {

// FT Technologies FT7xx (and FT205): acoustic resonance anemometers, polled by "$<listener>,WV?*hh" or continuous.
//
//   $<talker>,WVP=sss.s,ddd,n*hh     speed in m/s, direction in degrees from the datum, status ('0' is good)
//   $<talker>MWV,...                 NMEA, as configured
//
// hh is the exclusive or of what stands between '$' and '*'; "//" stands for a checksum that was switched off. The
// talker is two characters, WI by default. Source: FT702LT manual sections 5.3 and 6.4.25 ("$WI,WVP=020.0,045,0*73").

struct FtOptions {
  WhenMissing checksum = WhenMissing::kRefuse;
  WhenMissing status = WhenMissing::kRefuse;  ///< of either format; a reading without one is kUncertain
};

/// The wind in one line, or why there is none: as sentence_of() refuses, then kNotMine (a reply to another command),
/// kMalformed, kInvalid (by its status, or without a value), kImplausible. Thread-safe and realtime-safe: yes.
Result<DecodedWind, Refusal> decode_ft(const FtOptions& options, std::string_view line) noexcept;

}  // namespace yuragi::drivers::decode::text
