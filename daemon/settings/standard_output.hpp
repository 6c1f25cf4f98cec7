#pragma once

#include <string_view>

namespace yuragi {

/// Writes `text` to standard output at once, so that whoever reads it there need not wait for more. Throws
/// FailureError (kCannotCreate) where that is not possible: a full disk, say.
void write_at_once(std::string_view text);

}  // namespace yuragi
