#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "drivers/decode/byte_order.hpp"
#include "drivers/decode/decoded_wind.hpp"
#include "drivers/decode/refusal.hpp"
#include "engine/base/result.hpp"
#include "engine/wind/station_quantities.hpp"

namespace yuragi::drivers::decode::lufft {

// Lufft's UMB protocol, binary: VENTUS, V200A, and the weather stations WS200-UMB to WS800-UMB, which leave the factory
// with it. Sources: Lufft V200A-UMB manual V25, 20.3; WS manual, 6.8 and 6.9 (channels); OttHydromet/node-red-umbparser
// (the query of several channels); drivers/SOURCES.md S13.1.
//
//   0          01h SOH
//   1          10h version 1.0
//   2, 3       address of the receiver: class in the upper four bits (7: weather station, 8: VENTUS, 15: who asks), id
//   4, 5       address of the sender
//   6          n, bytes between STX and ETX
//   7          02h STX
//   8          command: 23h asks for one channel, 2Fh for several
//   9          10h its version
//   10 ...     what belongs to the command
//   8+n        03h ETX
//   9+n, 10+n  checksum of all before it
//   11+n       04h EOT
//
//   request 2Fh   number of channels; each channel
//   reply 2Fh     status; number of channels; for each: how many bytes follow, status, channel, type, value
//   reply 23h     status; channel, type, value
//
// Numbers have their low byte first. A status other than 0 means that there is no value: 24h the device does not have
// the channel, 28h it is not ready, 54h no valid data, 55h it cannot measure in this weather.

/// The address of the requester: of class 15, with any id.
inline constexpr std::uint16_t kUmbController = 0xF001;
constexpr bool is_umb_controller(std::uint16_t address) noexcept {
  return (address >> 12U) == 15;
}
/// Maximum number in a request; a frame has room for their values.
inline constexpr std::size_t kMaxUmbChannels = 20;
/// With the maximum of 210 bytes for a command.
inline constexpr std::size_t kMaxUmbFrame = 224;

namespace umb_channel {
inline constexpr std::uint16_t kAirTemperature = 100;    ///< degrees Celsius
inline constexpr std::uint16_t kRelativeHumidity = 200;  ///< %
inline constexpr std::uint16_t kPressure = 300;          ///< hPa, at the station
inline constexpr std::uint16_t kSpeed = 400;             ///< m/s; of a weather station the mean of 10 s
inline constexpr std::uint16_t kFastSpeed = 401;         ///< m/s, each second; a VENTUS needs none
inline constexpr std::uint16_t kMaxSpeed = 440;          ///< m/s, of the device's own recent past
inline constexpr std::uint16_t kDirection = 500;         ///< degrees, as kSpeed
inline constexpr std::uint16_t kFastDirection = 501;     ///< degrees, as kFastSpeed
inline constexpr std::uint16_t kRainTotal = 620;         ///< mm, since the last reset
inline constexpr std::uint16_t kRainRate = 820;          ///< mm/h
}  // namespace umb_channel

/// All of them: requested together in one exchange.
inline constexpr std::array kUmbChannels = {
    umb_channel::kFastSpeed, umb_channel::kSpeed,          umb_channel::kFastDirection, umb_channel::kDirection,
    umb_channel::kMaxSpeed,  umb_channel::kAirTemperature, umb_channel::kPressure,      umb_channel::kRelativeHumidity,
    umb_channel::kRainTotal, umb_channel::kRainRate};
/// What each device has.
inline constexpr std::array kUmbWindChannels = {umb_channel::kSpeed, umb_channel::kDirection};

/// The address of a device: its class (0 to 15) and its id.
constexpr std::uint16_t umb_address(unsigned device_class, std::uint8_t id) noexcept {
  return static_cast<std::uint16_t>((device_class << 12U) | id);
}

/// CRC-CCITT: polynomial 0x1021, from 0xFFFF on, lowest bit first. Thread-safe and realtime-safe: yes.
std::uint16_t umb_checksum(ByteSpan bytes) noexcept;

/// Returns true if these first bytes can be the beginning of such a frame. Thread-safe and realtime-safe: yes.
bool begins_umb_frame(ByteSpan beginning) noexcept;

/// How long it is, by its beginning of at least 7 bytes. Thread-safe and realtime-safe: yes.
std::size_t umb_frame_size(ByteSpan beginning) noexcept;

/// The frame that asks the device at `address` for `channels`, kMaxUmbChannels at most.
std::vector<std::uint8_t> umb_request(std::uint16_t address, std::span<const std::uint16_t> channels);

/// One channel of a reply.
struct UmbChannel {
  std::uint16_t channel = 0;
  std::uint8_t status = 0;      ///< 0: it has a value
  std::optional<double> value;  ///< finite
};

/// What a device replied.
struct UmbReply {
  std::uint16_t address = 0;
  std::array<UmbChannel, kMaxUmbChannels> channels{};
  std::size_t count = 0;

  /// Returns that channel; nullptr if the reply does not have it.
  const UmbChannel* find(std::uint16_t channel) const noexcept;
};

/// The reply in one frame; or the first thing that is wrong with it: kTooShort, kMalformed (longer, or not the layout),
/// kBadChecksum, kNotMine (a request, another command, or not from `address` if one is given), kException (the status
/// of the whole is not 0), kMalformed (its channels). Thread-safe and realtime-safe: yes.
Result<UmbReply, Refusal> decode_umb_reply(std::optional<std::uint16_t> address, ByteSpan frame) noexcept;

/// The wind of a reply: the fast channels before the others. kInvalid (no speed and no direction), kImplausible. An
/// impossible direction is left out, and the reading uncertain; a gust below the speed, which is of a time before, is
/// left out. Thread-safe and realtime-safe: yes.
Result<DecodedWind, Refusal> wind_of(const UmbReply& reply) noexcept;

/// Returns the other quantities in a reply, without its time. Values are not checked for their range
/// (wind::plausible_part). Thread-safe and realtime-safe: yes.
wind::StationQuantities quantities_of(const UmbReply& reply) noexcept;

}  // namespace yuragi::drivers::decode::lufft
