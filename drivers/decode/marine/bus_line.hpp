#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

#include "drivers/decode/marine/canboat.hpp"
#include "drivers/decode/marine/candump.hpp"
#include "drivers/decode/marine/wind_data.hpp"

namespace yuragi::drivers::decode::marine {

/// How a gateway or program writes the messages of an NMEA 2000 bus.
enum class BusLineFormat : std::uint8_t {
  kAuto,  ///< detected, line by line
  kYachtDevices,
  kCanboat,
  kCandump,  ///< also a CAN interface's
  kCanboatPlain,
  kActisense,  ///< N2K ASCII
};
inline constexpr std::array<std::string_view, 6> kBusLineFormatNames = {"auto",    "yacht-devices", "canboat",
                                                                        "candump", "canboat-plain", "actisense"};

/// Returns the format of a line by its look, also behind the time of a Signal K log; nullopt if it is none of them.
/// Thread-safe and realtime-safe: yes.
std::optional<BusLineFormat> bus_line_format_of(std::string_view line) noexcept;

/// What a line's time counts from.
enum class BusLineClock : std::uint8_t {
  kDate,              ///< "2018-02-14T15:55:07.944Z", "2013-05-05-10:11:12.123"
  kMidnight,          ///< "17:33:21.179" or "173321.107": the day is not in the line
  kUnixSeconds,       ///< "1436509052.249713"; candump may also count from its start, or from the line before
  kUnixMilliseconds,  ///< "1597516803000": of a Signal K log
};
struct BusLineTime {
  BusLineClock clock = BusLineClock::kDate;
  std::string_view text = {};  ///< as it is written, a part of the line; never empty
};

/// Returns the time in a line of any of these formats, or else that of the Signal K log in which it stands; nullopt if
/// it has none. Digits are not checked for their range. Thread-safe and realtime-safe: yes.
std::optional<BusLineTime> bus_line_time(std::string_view line) noexcept;

/// canboat's longest records have some thousand bytes.
inline constexpr std::size_t kMaxBusLine = 8192;

struct BusLineOptions {
  BusLineFormat format = BusLineFormat::kAuto;
  std::optional<AngleUnit> angle_unit;  ///< of canboat; nullopt: as its lines show it
};

/// Decodes the lines of one source in their order, and keeps what is sent only once: canboat's unit of angles, and the
/// state of a CAN controller. Thread-safe: no.
class BusLineDecoder {
 public:
  explicit BusLineDecoder(const BusLineOptions& options) : options_(options), angle_unit_(options.angle_unit) {}

  /// The wind in a line, or the refusal of its format's decoder. A line of a Signal K log ("1597516803000;A;", then
  /// what was received) is decoded without its head. Refusals before those of the decoder: kTooShort (an empty line),
  /// kNotMine (a Signal K log's line of another protocol), kMalformed (a line of no format, or not of the only one
  /// accepted).
  Result<BusWind, Refusal> decode(std::string_view line);
  /// Another stream of lines begins.
  void restart() { *this = BusLineDecoder(options_); }

  /// Returns true if the last wind of canboat has no direction because the unit of its angles is unknown.
  bool lacks_angle_unit() const noexcept { return lacks_angle_unit_; }
  ControllerState controller() const noexcept { return controller_; }

 private:
  Result<BusWind, Refusal> decode_as(BusLineFormat format, std::string_view line);
  Result<BusWind, Refusal> decode_json(std::string_view line);
  Result<BusWind, Refusal> decode_dump(std::string_view line);

  BusLineOptions options_;
  std::optional<AngleUnit> angle_unit_;  // nullopt: not known yet
  bool lacks_angle_unit_ = false;
  ControllerState controller_ = ControllerState::kGood;
};

}  // namespace yuragi::drivers::decode::marine
