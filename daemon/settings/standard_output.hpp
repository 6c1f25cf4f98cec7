#pragma once

#include <string_view>

namespace yuragi::daemon::settings {

/// Writes `text` to standard output and flushes it. Throws FailureError (kCannotCreate) if that fails (a full disk).
void write_at_once(std::string_view text);

}  // namespace yuragi::daemon::settings
