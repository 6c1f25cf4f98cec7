#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "drivers/decode/decoded_wind.hpp"
#include "tests/hurt/damage.hpp"

namespace yuragi::hurt {

using drivers::decode::DecodedWind;

/// What a message carries against damage.
enum class Checksum : std::uint8_t {
  kNone,
  kXor8,   ///< all bytes, exclusive or
  kSum8,   ///< their sum, 8 bits of it
  kSum16,  ///< the same, 16 bits
  kCrc16,
};

/// A whole message, and the wind that it was made of. Its reference and status are the decoder's.
struct Message {
  std::string bytes;
  DecodedWind wind;
};

inline DecodedWind wind_of(std::optional<double> speed_m_s, std::optional<double> direction_deg = {},
                           std::optional<double> gust_m_s = {}) {
  DecodedWind wind;
  wind.speed_m_s = speed_m_s;
  wind.direction_deg = direction_deg;
  wind.gust_m_s = gust_m_s;
  return wind;
}

/// One protocol whose messages are hurt. To add one is a function that makes messages, one that reads them, and a row
/// in the table of its kind.
struct Protocol {
  std::string_view name = {};
  Checksum checksum = Checksum::kNone;
  /// Messages follow each other without a pause, so that what is lost of one is made up of the next: the decoder gets
  /// the hurt one and a whole one behind it.
  bool is_stream = false;
  /// Of a million hurt messages, so many give a false wind at most (README.md says why). What the checksum always finds
  /// gives none, whatever is allowed here.
  int most_false_of_a_million = 0;
  Message (*make)(Chance& chance) = nullptr;
  /// All winds that the decoder, as its driver uses it, takes from these bytes.
  std::vector<DecodedWind> (*winds_in)(std::string_view bytes) = nullptr;
};

// Each kind's table stands at the end of its file.
std::span<const Protocol> byte_protocols();
std::span<const Protocol> text_protocols();
std::span<const Protocol> json_protocols();

}  // namespace yuragi::hurt
