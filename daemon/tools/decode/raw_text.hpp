#pragma once

#include <string>

#include "engine/wire/wire.hpp"

namespace yuragi {

/// A message to or from a device, for a terminal: when (UTC), which sensor, "<-" from the device or "->" to it, its
/// bytes in hexadecimal digits, 16 a line, and beside them as text. A line before it tells of messages that were passed
/// over. Lines end in '\n' and have 100 columns at most.
std::string raw_text(const wire::RawTrace& trace);

/// Messages as `yuragi decode --hex` reads them: what was received, in hexadecimal digits, a line each; behind what was
/// sent just before, "request | response". Thread-safe: no.
class RawHexLines {
 public:
  /// The line of this message; empty for one that was sent, which waits for its answer.
  std::string line_of(const wire::RawTrace& trace);

 private:
  std::string sensor_;
  std::vector<std::uint8_t> request_;
};

}  // namespace yuragi
