#pragma once

#include <filesystem>
#include <shared_mutex>
#include <system_error>

namespace yuragi::drivers::windlog {

// A recording is one file, and what SQLite keeps beside it while somebody has it open, or if its writer was killed:
// FILE-wal then holds its newest readings, and SQLite finds it by the recording's name alone.

/// Held shared by a thread of this process that opens a recording, until SQLite has what lies beside it open as well,
/// and alone while one is renamed or removed. SQLite's locks, which are POSIX's, do not hold between threads of one
/// process: who opened a recording's file before it was renamed, and what lies beside the next file after it, would
/// truncate memory that the writer of the next file uses, and end the process.
std::shared_mutex& recording_names();

/// Renames a recording with what is beside it, first what is beside it. Where that fails everything keeps its name.
std::error_code rename_recording(const std::filesystem::path& from, const std::filesystem::path& to);

/// Is this name free, and those that SQLite would use beside it?
bool is_free_name(const std::filesystem::path& file);

/// Removes a recording with what is beside it, which goes first. Returns whether there was one.
bool remove_recording(const std::filesystem::path& file);

/// Carries a rename_recording() of `recording` to one of its parts to its end, if the process was killed in the midst
/// of it: what was beside the recording has the part's name already, and the recording has not.
void finish_rename_to_part(const std::filesystem::path& recording);

}  // namespace yuragi::drivers::windlog
