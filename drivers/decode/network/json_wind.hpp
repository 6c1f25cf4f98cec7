#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "drivers/decode/decoded_wind.hpp"
#include "drivers/decode/refusal.hpp"
#include "engine/base/result.hpp"

namespace yuragi::drivers::decode::network {

// The wind in any JSON that a web server answers with: weather services, Shelly, ESPHome, Home Assistant. Where its
// values stand is configured (drivers/SOURCES.md S9.4).
//
//   speed, gust   a number, or a number as a text; null, "unavailable" and the like: no value
//   direction     degrees that the wind comes from, in the same ways, or a point of the compass: "NW"
//   time          of the observation: a number or a text, as it stands

/// The answers of weather services are some KiB; a day of hourly forecasts beside them can be some hundred.
inline constexpr std::size_t kMaxJsonAnswer = 1024UL * 1024;
inline constexpr std::size_t kMaxJsonTime = 64;

/// JSON pointers (RFC 6901) to the values; empty: the answer does not have it.
struct JsonPlaces {
  std::string speed{};
  std::string direction{};
  std::string gust{};
  std::string time{};
  double metres_per_second = 1.0;  ///< of the unit of speed and gust
};

struct JsonWind {
  DecodedWind wind;    ///< with a speed
  std::string time{};  ///< of the observation; empty: none, or one that is longer than kMaxJsonTime
};

/// The wind in an answer, or the first thing that is wrong with it: kMalformed (too long, not JSON, or no number where
/// the speed stands), kInvalid (no speed), kImplausible (no wind blows so fast). Nothing else than the speed discards
/// an answer: a direction or gust that cannot be read is left out, and the wind is uncertain. JSON has no checksum.
/// Allocates at most some hundred times the answer's size; throws std::bad_alloc if there is no such memory, and
/// nothing else for any bytes. Thread-safe: yes.
Result<JsonWind, Refusal> decode_json_wind(std::string_view answer, const JsonPlaces& places);

}  // namespace yuragi::drivers::decode::network
