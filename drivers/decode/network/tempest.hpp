#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "drivers/decode/decoded_wind.hpp"
#include "drivers/decode/refusal.hpp"
#include "engine/base/result.hpp"
#include "engine/wind/station_quantities.hpp"

namespace yuragi::drivers::decode::network {

// What a hub of WeatherFlow's (Tempest; before it Air and Sky) broadcasts, one JSON object in a datagram.
// Source: WeatherFlow, "Tempest UDP Reference", v171; drivers/SOURCES.md S9.1.
//
//   every message   "serial_number" of the station (of the hub itself: hub_status), "type", "hub_sn"
//   rapid_wind      "ob": [time, speed, direction]
//   obs_st          "obs": [[0 time, 1 lull, 2 average, 3 gust, 4 direction, 5 sample interval, 6 station pressure,
//                   7 temperature, 8 humidity, 9 to 11 light, 12 rain of the last minute, 13 to 16 others,
//                   17 report interval]]
//   obs_sky         "obs": [[0 time, 1 and 2 light, 3 rain of the last minute, 4 lull, 5 average, 6 gust, 7 direction,
//                   8 battery, 9 report interval, 10 light, 11 rain of the day, 12 kind of rain, 13 sample interval]]
//
// Times are seconds since 1970, speeds m/s, directions degrees that the wind comes from, pressure hPa, temperatures
// degrees Celsius, rain mm, report intervals minutes. Any value can be null. In a calm speed and direction are 0.

/// The hub's messages are shorter than 1 KiB.
inline constexpr std::size_t kMaxTempestMessage = 4096;

/// The subject of a message.
enum class TempestKind : std::uint8_t {
  kRapidWind,    ///< the wind of a moment
  kObservation,  ///< the last minute or minutes: mean wind, gust, and what else the station measures
  kOther,        ///< no wind: the state of a device, rain that begins, lightning, a station without an anemometer
};

/// One message of a hub.
struct TempestMessage {
  std::string serial_number;      ///< whose values they are: "ST-00000512"; or, of the hub itself, "HB-00013030"
  std::string hub_serial_number;  ///< "HB-00013030"
  TempestKind kind = TempestKind::kOther;
  std::int64_t time_s = 0;  ///< of the values, by the hub's clock, since 1970; 0 for kOther
  /// kInvalid: the station has no value. kImplausible. kNotMine: kOther.
  Result<DecodedWind, Refusal> wind = Refusal::kNotMine;
  /// Without its time. Values are not checked for their range (wind::plausible_part).
  wind::StationQuantities quantities = {};
};

/// A datagram of a hub, or what is wrong with it: kTooShort (empty, or too few values), kMalformed (not JSON, or not
/// such a message). JSON has no checksum: a digit that was changed on the way is another number, which only its range
/// can give away. Allocates at most some ten times kMaxTempestMessage; throws std::bad_alloc if there is no such
/// memory, and nothing else for any bytes. Thread-safe: yes.
Result<TempestMessage, Refusal> decode_tempest(std::string_view datagram);

/// Which of the messages of one station are its wind, in the order in which they come. Thread-safe: no. Realtime-safe:
/// yes.
class TempestWinds {
 public:
  /// False for one that has been heard already: a machine with two interfaces in the hub's network hears everything
  /// twice. Not for kOther.
  bool is_new(const TempestMessage& message) noexcept;
  /// Returns true for a new message: an observation is the wind if no rapid wind was received since the observation
  /// before.
  bool is_wind(const TempestMessage& message) noexcept;

 private:
  std::int64_t last_rapid_wind_s_ = 0;  // by the hub's clock
  std::int64_t last_observation_s_ = 0;
  bool rapid_winds_are_missing_ = false;  // since the last observation
};

}  // namespace yuragi::drivers::decode::network
