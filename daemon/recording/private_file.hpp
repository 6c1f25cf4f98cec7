#pragma once

#include <filesystem>

namespace yuragi::daemon::recording {

/// Creates an empty file that its owner can write, its group can read and others cannot (mode 0640, less what the
/// process's umask takes away), if there is none of that name: SQLite would let everybody read it, and gives the
/// files beside it (-wal, -shm) the mode of the file. One that exists is not touched: neither opened nor its mode
/// changed. A symbolic link to a file that does not exist yet is followed.
///
/// Does nothing if the file cannot be created: opening it next reports the reason. Thread-safe: yes.
void create_private_file(std::filesystem::path file);

}  // namespace yuragi::daemon::recording
