#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "tests/hurt/protocol.hpp"

namespace yuragi::hurt {

/// What came of so many hurt messages of one protocol. Each is counted once, as the worst of what was read from it.
struct Tally {
  std::int64_t messages = 0;
  std::int64_t refused = 0;                 ///< no wind was read from it
  std::int64_t unharmed = 0;                ///< the wind that was sent, or a part of it
  std::int64_t others = 0;                  ///< of two spliced messages the other one's wind
  std::int64_t wrong = 0;                   ///< a wind that no message said
  std::int64_t found = 0;                   ///< of these: the checksum finds such damage always
  std::int64_t impossible = 0;              ///< of these: out of its physical range, or no number
  std::vector<std::string> found_examples;  ///< the first hurt messages of each, printable
  std::vector<std::string> impossible_examples;
  std::vector<std::string> wrong_examples;
};

/// The false winds that may be in so many messages: the bound, and three standard deviations of chance.
std::int64_t most_false(const Protocol& protocol, std::int64_t messages);

/// Hurts so many messages. Throws std::runtime_error where a whole message is not read as it was made.
Tally try_protocol(const Protocol& protocol, std::int64_t messages, std::uint64_t seed);

/// What is wrong with that tally, in words; nothing if all is well.
std::optional<std::string> verdict(const Protocol& protocol, const Tally& tally);

}  // namespace yuragi::hurt
