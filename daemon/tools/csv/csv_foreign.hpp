#pragma once

#include <optional>
#include <string_view>

namespace yuragi::daemon::tools::csv {

/// What a file is that is neither a table nor a log, by its first bytes, and what to do with it: "a photo (JPEG)";
/// nullopt if it can be text. Thread-safe: yes.
std::optional<std::string_view> foreign_kind(std::string_view beginning);

}  // namespace yuragi::daemon::tools::csv
