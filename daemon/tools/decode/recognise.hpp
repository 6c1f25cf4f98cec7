#pragma once

#include <cstddef>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace yuragi::daemon::tools::decode {

/// What one format's decoder makes of lines.
struct Recognition {
  std::string_view format = {};
  std::size_t winds = 0;
  std::map<std::string_view, std::size_t> refused = {};  ///< lines by the reason, but those that are of another format
};

/// Gives the lines to the decoder of each text format with its default options. Those that read a wind, the one with
/// the most first; then those that know a line of theirs. Thread-safe: yes.
std::vector<Recognition> recognise(std::span<const std::string> lines);

/// "nmea2000 (617 winds in 1,000 lines)": the best of them; empty if none reads a wind.
std::string recognised_text(std::span<const std::string> lines);

}  // namespace yuragi::daemon::tools::decode
