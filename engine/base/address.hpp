#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "engine/base/result.hpp"

namespace yuragi {

/// Where to listen or connect: a name or an IP address, and a port.
struct Address {
  std::string host;
  std::uint16_t port = 0;  ///< 0 takes any free port, for listening
};

/// Reads "HOST:PORT", an IPv6 address in brackets ("[::1]:7410"). ":PORT" can be omitted if there is a `default_port`.
/// The failure states what is allowed. Pure.
Result<Address, Failure> parse_address(std::string_view text, std::optional<std::uint16_t> default_port = std::nullopt);

/// The same form again.
std::string to_string(const Address& address);

}  // namespace yuragi
