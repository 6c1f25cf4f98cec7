#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "drivers/decode/decoded_wind.hpp"
#include "drivers/decode/refusal.hpp"
#include "engine/base/result.hpp"
#include "engine/wind/station_quantities.hpp"

namespace yuragi::drivers::decode::network {

// What weather stations and gateways push to a server over HTTP: a form (name=value&name=value, percent-encoded), as
// the body of a POST (Ecowitt) or behind the question mark of a GET (Weather Underground, Ambient Weather, WSLink).
// Sources: drivers/SOURCES.md S9.3.
//
//   what                    Ecowitt                     Ambient Weather    Weather Underground
//   which station           PASSKEY                     PASSKEY            ID (and PASSWORD)
//   what it is              stationtype, model          stationtype        softwaretype
//   mean wind, gust         windspeedmph, windgustmph   the same           the same               miles per hour
//   direction               winddir                     the same           the same               degrees
//   temperature, humidity   tempf, humidity             the same           the same               Fahrenheit, %
//   pressure: at it         baromabsin                  baromabsin         absbaromin             inches of mercury
//   pressure: at sea level  baromrelin                  baromrelin         baromin
//   rain: most lasting sum  totalrainin, yearlyrainin   totalrainin        yearlyrainin           inches
//                           (piezo: yrain_piezo)                           or dailyrainin
//   rate of rain            rainratein (rrain_piezo)                                              inches an hour
//   time                    dateutc                     dateutc            dateutc
//
// WSLink (consoles of CCL: Bresser, Garni, Ventus, Sencor, Youshiko; GET /data/upload.php) has units of its own:
//
//   wsid, wspw              which station, its password
//   t1ws, t1wgust, t1wdir   wind, gust (m/s), direction (degrees)
//   t1tem, t1hum            temperature (degrees Celsius), humidity (%)
//   abar, rbar              pressure at the console, at sea level (hPa)
//   t1rainyr, t1rainra      rain of the year (mm), its rate (mm/h)
//   t1cn                    0: the console does not receive the sensors; their values are old
//
// A form with a value of the wind or the name of a station of the table above is never read as WSLink.
//
// A value that is missing is -9999, empty, or left out. The time is that of the gateway's clock, which is wrong without
// internet: it is not used.

/// Longer than any push: stations with all sensors that a gateway can receive send less than 4 KiB.
inline constexpr std::size_t kMaxStationPush = 16UL * 1024;

/// The values in a push. The views are parts of the form.
struct StationPush {
  std::string_view identity = {};  ///< PASSKEY, ID or wsid, as it stands in the form: a secret; empty: it has neither
  std::string_view kind = {};  ///< what the station is, percent-encoded: "GW2000A_V2.1.5", "WSLink"; empty: not sent
  /// Without its time. Values are not checked for their range (wind::plausible_part).
  wind::StationQuantities quantities = {};
  /// kInvalid: it has no speed, or the console does not receive the sensors. kMalformed: the speed is not a number.
  /// kImplausible. A gust below the mean wind is left out.
  Result<DecodedWind, Refusal> wind = Refusal::kInvalid;
};

/// The path and the form of a request's target.
struct PushTarget {
  std::string_view path = {};  ///< without slashes at its end: "/data/report"
  std::string_view form = {};
};

/// Splits "/data/report/?PASSKEY=..." into its parts. Stations whose path was typed without a question mark at its end
/// send "/data/report/PASSKEY=...", and some firmware sends "PASSKEY=..." without a path: without a question mark, the
/// form begins behind the last slash before the first '='. Thread-safe and realtime-safe: yes.
PushTarget split_push_target(std::string_view target) noexcept;

/// A form, without the line end behind it, or the first thing that is wrong with it: kTooShort (empty), kMalformed (too
/// long, not visible ASCII, or a value of the table above that stands there twice), kNotMine (neither a station nor a
/// wind in it). There is no checksum but TCP's. Thread-safe and realtime-safe: yes.
Result<StationPush, Refusal> decode_station_push(std::string_view form) noexcept;

/// "a+b%20c", a name or value of a form, as "a b c"; other text is unchanged. Thread-safe: yes.
std::string percent_decoded(std::string_view text);

/// Any bytes as they may be shown and recorded: each part between '&' that mentions a key, a password or a token is
/// replaced by "(secret)", except the names PASSKEY, PASSWORD and wspw. The rest of a form can be decoded. Thread-safe:
/// yes.
std::string without_push_secrets(std::string_view form);

/// A value of a form as text for people: decoded, visible ASCII alone, at most 40 characters. Thread-safe: yes.
std::string push_text(std::string_view value);

}  // namespace yuragi::drivers::decode::network
