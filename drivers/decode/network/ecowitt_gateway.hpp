#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "drivers/decode/byte_order.hpp"
#include "drivers/decode/refusal.hpp"
#include "engine/base/result.hpp"

namespace yuragi::drivers::decode::network {

// How gateways by Fine Offset are found: they answer a broadcast to UDP port 46000. Source: drivers/SOURCES.md S9.20.
//
//   question  ff ff 12 03 15
//   answer    ff ff, 12, size (2 bytes), MAC address (6), IPv4 address (4), TCP port (2), length of the name, name,
//             checksum (of all from the command on)
//
// The name is that of its own wireless network, with its version: "GW1000-WIFIFD32 V1.6.8".

/// The question for gateways.
inline constexpr std::array<std::uint8_t, 5> kEcowittSearch = {0xFF, 0xFF, 0x12, 0x03, 0x15};

/// A gateway that has answered.
struct EcowittGateway {
  std::string mac;         ///< "50:02:91:e3:fd:32"
  std::uint16_t port = 0;  ///< TCP, for requests
  std::string name;        ///< can be shown; at most 64 characters
};

/// A reply, or the error in it: kTooShort, kMalformed, kNotMine (another command's), kBadChecksum. The IPv4 address in
/// it is not read: the sender's address is used. Thread-safe: yes.
Result<EcowittGateway, Refusal> decode_ecowitt_gateway(ByteSpan answer);

}  // namespace yuragi::drivers::decode::network
