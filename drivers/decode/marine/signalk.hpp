#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "drivers/decode/decoded_wind.hpp"

namespace yuragi::drivers::decode::marine {

// Signal K 1.x, as a stream of JSON, one object a line: first the server's hello, then deltas.
//
//   {"name":"signalk-server","version":"2.14.4","timestamp":"2026-06-21T15:09:16.704Z",
//    "self":"vessels.urn:mrn:signalk:uuid:c0d79334-4e25-4245-8892-54e8ccc8021d","roles":["master","main"]}
//   {"context":"vessels.urn:mrn:signalk:uuid:c0d79334-4e25-4245-8892-54e8ccc8021d","updates":[
//    {"$source":"n2k.105","timestamp":"2026-06-21T15:09:17.012Z","values":[
//     {"path":"environment.wind.speedApparent","value":4.01},{"path":"environment.wind.angleApparent","value":-0.22}]}]}
//
// Values are in m/s and radians; angles from the bow are negative to port. An unknown value is null. A server sends
// each value of a message in a delta of its own, with the message's source and time. Sources: drivers/SOURCES.md S11.

/// Deltas of one message have some hundred bytes, those of many values some thousand.
inline constexpr std::size_t kMaxDelta = 16384;

/// The values below environment.wind that are read.
enum class SignalKQuantity : std::uint8_t {
  kSpeedApparent,
  kSpeedTrue,  ///< through the water
  kSpeedOverGround,
  kAngleApparent,  ///< from the bow
  kAngleTrueWater,
  kAngleTrueGround,
  kDirectionTrue,  ///< from geographic north
  kDirectionMagnetic,
};
inline constexpr std::size_t kSignalKQuantities = 8;

/// m/s, or degrees clockwise in [0, 360); empty: not sent, or null.
using SignalKValues = std::array<std::optional<double>, kSignalKQuantities>;

/// The wind in one update.
struct SignalKUpdate {
  std::string source;     ///< which of the server's sources; printable, at most 64 bytes
  std::string timestamp;  ///< as sent, at most 64 bytes; empty: none
  SignalKValues values;
};

struct SignalKDelta {
  std::string context;  ///< the vessel, as sent; empty: the server's own
  std::vector<SignalKUpdate> updates;
};

struct SignalKHello {
  std::string timestamp;  ///< the server's time; empty: it has no clock
  std::string self;       ///< the context of its own vessel; empty: it has none
};

/// Returns the server's first message; nullopt if the line is another one. Thread-safe: yes.
std::optional<SignalKHello> signalk_hello(std::string_view line);

/// The updates of one line that have a value of the wind. Refusals, in this order: kMalformed (no JSON object, or not
/// this format), kNotMine (no value of the wind), kInvalid (null alone), kImplausible (a speed that is none). An
/// impossible angle is left out. Never throws for any line, except if memory runs out. Thread-safe: yes.
Result<SignalKDelta, Refusal> decode_signalk(std::string_view line);

/// The wind from values of one moment, in one frame.
struct SignalKWind {
  std::string_view frame;  ///< "north", "magnetic", "apparent", "ground" or "water"
  DecodedWind wind;
};
inline constexpr std::size_t kSignalKFrames = 5;

/// The winds that these values make, best frame first: each with a speed; without a direction, that is empty. A
/// direction from north has the speed over ground, or the true one. Thread- and realtime-safe.
std::array<std::optional<SignalKWind>, kSignalKFrames> signalk_winds(const SignalKValues& values) noexcept;

}  // namespace yuragi::drivers::decode::marine
