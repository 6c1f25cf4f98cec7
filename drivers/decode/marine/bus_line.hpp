#pragma once

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
};

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

  /// The wind in a line, or the refusal of its format's decoder.
  Result<BusWind, Refusal> decode(std::string_view line);
  /// Another stream of lines begins.
  void restart() { *this = BusLineDecoder(options_); }

  /// Returns true if the last wind of canboat has no direction because the unit of its angles is unknown.
  bool lacks_angle_unit() const noexcept { return lacks_angle_unit_; }
  ControllerState controller() const noexcept { return controller_; }

 private:
  Result<BusWind, Refusal> decode_json(std::string_view line);
  Result<BusWind, Refusal> decode_dump(std::string_view line);

  BusLineOptions options_;
  std::optional<AngleUnit> angle_unit_;  // nullopt: not known yet
  bool lacks_angle_unit_ = false;
  ControllerState controller_ = ControllerState::kGood;
};

}  // namespace yuragi::drivers::decode::marine
