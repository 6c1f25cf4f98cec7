#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "drivers/decode/refusal.hpp"
#include "engine/base/result.hpp"
#include "engine/base/time.hpp"

namespace yuragi::drivers::bus {

/// One message of Open Sound Control (M. Wright, "The Open Sound Control 1.0 specification", 2002).
struct OscMessage {
  std::string address;                         ///< "/wind"
  std::vector<std::optional<double>> numbers;  ///< its arguments in their order; empty: not a number
  std::optional<UtcTime> meant_for;            ///< the latest time tag of the bundles that it is in; empty: at once
};

/// The messages in one datagram, parsed by liblo: one, or those of a bundle and of the bundles in it, whatever time
/// they are meant for. A time tag counts from 1900, or from 2036 on from there (RFC 4330, 3); 1, the mark for "at
/// once", and 0 are none. kMalformed if any of it is not OSC, kTooShort for an empty one. Opens nothing, and never
/// throws for any bytes. Thread-safe: yes.
Result<std::vector<OscMessage>, decode::Refusal> decode_osc(std::span<const std::uint8_t> datagram);

/// A message with numbers, or with a text, as bytes; arguments have the types f and s. The numbers are finite.
std::vector<std::uint8_t> encode_osc(const std::string& address, std::span<const float> numbers);
std::vector<std::uint8_t> encode_osc(const std::string& address, const std::string& text);

/// A bundle of encoded messages. Without a time tag it is meant for at once.
std::vector<std::uint8_t> encode_osc_bundle(std::span<const std::vector<std::uint8_t>> messages,
                                            std::optional<UtcTime> meant_for);

/// Returns true if `address` matches `pattern`. OSC's own patterns: ? * [a-z] {this,that}.
bool osc_address_matches(const std::string& address, const std::string& pattern);

}  // namespace yuragi::drivers::bus
