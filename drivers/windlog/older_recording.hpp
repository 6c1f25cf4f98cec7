#pragma once

#include <filesystem>
#include <optional>

#include "engine/base/result.hpp"

namespace yuragi::drivers::windlog {

/// Renames a recording of an older version of the format, which is read but not continued, with what SQLite keeps
/// beside it: wall.windlog becomes wall-format1.windlog, or wall-format1-2.windlog if that is taken. Returns the new
/// name; nullopt if there is no such file, or it is something else; it is then left as it is. Thread-safe: yes.
Result<std::optional<std::filesystem::path>, Failure> set_older_recording_aside(const std::filesystem::path& file);

}  // namespace yuragi::drivers::windlog
