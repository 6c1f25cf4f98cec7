#pragma once

namespace yuragi {

/// The release that this was built from, "0.2.0": CMakeLists.txt's.
extern const char* const kVersion;

}  // namespace yuragi
