#pragma once

#include <string>

#include "engine/wire/wire.hpp"

namespace yuragi::daemon::tools::decode {

/// A message to or from a device, for a terminal: time (UTC), sensor, "<-" from the device or "->" to it, and its bytes
/// in hexadecimal digits, 16 a line, with their text beside. A line before it gives the number of messages that were
/// dropped. Lines end in '\n' and have 100 columns at most.
std::string raw_text(const wire::RawTrace& trace);

/// Messages in the format that `yuragi decode --hex` reads: a line of hexadecimal digits for each received message, as
/// "request | response" if a message was sent just before. Thread-safe: no.
class RawHexLines {
 public:
  /// The line of this message; empty for one that was sent, which is kept until its reply.
  std::string line_of(const wire::RawTrace& trace);

 private:
  std::string sensor_;
  std::vector<std::uint8_t> request_;
};

}  // namespace yuragi::daemon::tools::decode
