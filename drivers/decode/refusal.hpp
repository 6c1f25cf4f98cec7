#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>

namespace yuragi::drivers::decode {

/// Why something that arrived, or did not, was not published. Each is counted for each sensor.
enum class Refusal : std::uint8_t {
  kTimeout,   ///< no reply in time
  kTooShort,  ///< a reply that ends too early
  kNotMine,   ///< a reply of another device, or to another request
  kBadChecksum,
  kException,    ///< the device replied with an exception
  kMalformed,    ///< not the protocol
  kInvalid,      ///< the device's own mark for "no value"
  kImplausible,  ///< decoded, but no wind blows like that
  kTooFrequent,  ///< more readings a second than are taken (sensor::ReadingLimit)
  kOverrun,      ///< came faster than it could be received: dropped by the kernel
};
inline constexpr std::size_t kRefusalCount = 10;

std::string_view name_of(Refusal refusal);

}  // namespace yuragi::drivers::decode
