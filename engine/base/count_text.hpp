#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace yuragi {

/// A number of things for a person to read: "1 reading", "0 readings". For nouns whose plural ends in s.
inline std::string count_text(std::uint64_t count, std::string_view noun) {
  return std::to_string(count) + " " + std::string(noun) + (count == 1 ? "" : "s");
}

}  // namespace yuragi
