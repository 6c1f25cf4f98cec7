#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "drivers/decode/modbus/modbus_quantity.hpp"
#include "drivers/sensor/stated_value.hpp"
#include "engine/base/time.hpp"
#include "engine/wind/station_quantities.hpp"

namespace yuragi::drivers::modbus {

/// The rates that a serial line may have, bit/s.
inline constexpr std::array<std::int64_t, 8> kModbusBauds = {1200, 2400, 4800, 9600, 19200, 38400, 57600, 115200};

/// Who confirms that a register map is right, from strong to weak: bytes that a real device sent, the maker's own
/// document, a program that its users run with the device, a seller's text. The texts are those of profiles;
/// drivers/SOURCES.md.
enum class ProfileEvidence : std::uint8_t { kRecording, kMaker, kDecoder, kSeller };
inline constexpr std::array<std::string_view, 4> kProfileEvidenceNames = {"recording", "maker", "decoder", "seller"};

/// A quantity besides the wind, and its registers.
struct StationQuantity {
  wind::StationQuantity what{};  ///< one of wind::kStationQuantities
  decode::modbus::Quantity quantity;
};

/// A device's register map and request timing: one TOML file in drivers/modbus/profiles.
/// drivers/modbus/profiles/README.md lists the keys, drivers/SOURCES.md S1 the devices and their documents.
struct Profile {
  std::string name;    ///< of the device, for people
  std::string source;  ///< the document with its register map
  std::vector<ProfileEvidence> confirmed_by;
  std::string unconfirmed;  ///< unconfirmed parts, for people; empty: all is confirmed
  std::string revision;     ///< of the device or its firmware, if the map differs among them

  bool is_serial = true;  ///< its native transport; a serial device can also be reached over TCP, through a gateway
  int baud = 9600;
  char parity = 'N';  ///< N, E or O
  int stop_bits = 1;

  Nanoseconds poll_interval = std::chrono::milliseconds(250);     ///< more frequent requests return the same values
  Nanoseconds min_gap{0};                                         ///< from a reply to the next request
  Nanoseconds response_timeout = std::chrono::milliseconds(500);  ///< longest wait for a reply
  Nanoseconds byte_timeout = std::chrono::milliseconds(50);       ///< serial line: silence that ends a message
  Nanoseconds delay_after_open{0};                                ///< from opening to the first request
  Nanoseconds warm_up{0};                                         ///< from opening until readings are valid
  Nanoseconds quantities_interval = std::chrono::seconds(10);     ///< between two reads of `quantities`

  bool block_read = true;         ///< registers that adjoin may be read by one request
  int block_gap = 0;              ///< up to this many registers between two quantities can be read along with them
  double north_offset_deg = 0.0;  ///< added to the direction: the device's mark points there instead of to north

  decode::modbus::Quantity speed;
  std::optional<sensor::StatedValue> value;  ///< what the speed is; nullopt: unknown
  std::optional<decode::modbus::Quantity> direction;
  std::optional<decode::modbus::Quantity> gust;  ///< the device's own gust: its strongest recent speed
  /// The wind force that the device itself makes of its speed, in Beaufort: not read in service, but probing judges the
  /// speed's scale by it.
  std::optional<decode::modbus::Quantity> beaufort;
  std::vector<StationQuantity> quantities;
};

/// Reads a profile's text. Throws std::runtime_error "file:line:column: key: what is wrong, what is allowed"; `file` is
/// used in that text only. Keys that no profile has are refused.
Profile parse_modbus_profile(std::string_view text, std::string_view file);

/// Sets the id of the slave that measures the speed, and of all other quantities on the same slave.
void set_slave(Profile& profile, std::uint8_t id);

/// Finds and reads a profile: a path, if `name` contains '/' or ends in ".toml"; otherwise NAME.toml in `directory` (if
/// not empty), $YURAGI_PROFILE_DIR, ../share/yuragi/profiles beside the executable, the source tree.
/// Throws std::runtime_error as above, or, for a name that is nowhere, one that lists the names that are.
Profile load_modbus_profile(const std::string& name, const std::string& directory);

/// The names of all profiles that can be found so, in alphabetical order.
std::vector<std::string> modbus_profile_names(const std::string& directory);

}  // namespace yuragi::drivers::modbus
