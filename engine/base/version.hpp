#pragma once

#include <string>
#include <string_view>

namespace yuragi {

/// The release that this was built from, "0.2.0": CMakeLists.txt's.
extern const char* const kVersion;

/// "yuragi-viewer 0.2.0".
inline std::string with_version(std::string_view program) {
  return std::string(program) + " " + kVersion;
}

}  // namespace yuragi
