#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include "drivers/decode/decoded_wind.hpp"
#include "drivers/decode/text_fields.hpp"

namespace yuragi::drivers::decode::text {

// Lufft VENTUS, V200A and WS200-UMB to WS800-UMB in their two text modes:
//
//   "01TR4" requests   $WIMWV,230.6,R,003.4,N,A*23         NMEA mode; $WIMWV,,R,,M,V*hh on error
//   "& 28673 M 00400"  $ 28673 M 00400 12345               ASCII mode: device, channel, value; each five digits
//
// In ASCII mode 0 to 65520 stand for the channel's measuring range, 65521 to 65535 are error codes, and there is no
// checksum. One reply contains one channel. Wind speed: 400 actual, 420 least, 440 greatest (a gust), 460 mean, 480
// vector mean; +5 is the same in km/h, +10 in mph, +15 in knots: the same range, so the same m/s. Direction, 0 to 359.9
// degrees: 500 actual, 520 least, 540 greatest, 580 vector mean. Sources: Lufft V200A-UMB manual V25 20.5.4 (NMEA
// mode), WS501-UMB manual 18.4.3 (ASCII mode), WS manual 6.8 and 6.9 (channels). Their binary mode:
// drivers/decode/lufft.

struct UmbOptions {
  WhenMissing checksum = WhenMissing::kRefuse;  ///< of NMEA mode
  WhenMissing status = WhenMissing::kRefuse;    ///< of NMEA mode
  std::optional<std::uint16_t> device;          ///< of ASCII mode: take only this one's replies (28673 is WS no. 1)
  double speed_range_m_s = 75.0;                ///< of ASCII mode: what 65520 stands for; a VENTUS has 90
};

/// The wind in one line, or why there is none. NMEA mode: as decode_nmea(). ASCII mode: kTooShort, kNotMine (another
/// device or channel), kMalformed, kInvalid (an error code), kImplausible. Thread-safe and realtime-safe: yes.
Result<DecodedWind, Refusal> decode_umb(const UmbOptions& options, std::string_view line) noexcept;

}  // namespace yuragi::drivers::decode::text
