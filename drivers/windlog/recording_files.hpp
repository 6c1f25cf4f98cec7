#pragma once

#include <filesystem>
#include <system_error>

namespace yuragi::drivers::windlog {

// A recording is one file, and what SQLite keeps beside it while somebody has it open, or where its writer was killed:
// FILE-wal then holds its newest readings, and SQLite finds it by the recording's name alone.

/// Renames a recording with what is beside it, first what is beside it. Where that fails everything keeps its name.
std::error_code rename_recording(const std::filesystem::path& from, const std::filesystem::path& to);

/// Is this name free, and those that SQLite would use beside it?
bool is_free_name(const std::filesystem::path& file);

/// Removes a recording with what is beside it, which goes first. Returns whether there was one.
bool remove_recording(const std::filesystem::path& file);

/// Carries a rename_recording() of `recording` to one of its parts to its end, where the process was killed in the
/// midst of it: what was beside the recording has the part's name already, and the recording has not.
void finish_rename_to_part(const std::filesystem::path& recording);

}  // namespace yuragi::drivers::windlog
