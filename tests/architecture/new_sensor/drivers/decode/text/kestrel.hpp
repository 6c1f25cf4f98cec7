#pragma once

#include <string_view>

#include "drivers/decode/decoded_wind.hpp"
#include "drivers/decode/text_fields.hpp"

namespace yuragi::drivers::decode::text {

// The Kestrel, an anemometer that nobody makes: the example of CONTRIBUTING.md.
//
//   $K,sss.s,ddd.d*hh   speed in m/s, direction in degrees from its mark
//
// hh is the exclusive or of what stands between '$' and '*'.

/// The wind in one line, or why there is none: as sentence_of() refuses, then kNotMine (another device's sentence),
/// kMalformed, kImplausible. Thread-safe and realtime-safe: yes.
Result<DecodedWind, Refusal> decode_kestrel(std::string_view line) noexcept;

}  // namespace yuragi::drivers::decode::text
