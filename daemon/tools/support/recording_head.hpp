#pragma once

#include <filesystem>
#include <string>

#include "engine/base/time.hpp"

namespace yuragi::daemon::tools::support {

/// What a recording is, for a person: its files with their sizes, its sessions with times and software, its sensors,
/// and how many readings each has; "at least" if counting takes longer than `patience`. No configuration, since
/// recordings of older versions hold passwords in theirs; the reason if it cannot be read.
std::string recording_head(const std::filesystem::path& recording, Nanoseconds patience);

/// The readings of its last hour as CSV, as `yuragi export` writes it; the reason if it cannot be read.
std::string last_hour(const std::filesystem::path& recording);

}  // namespace yuragi::daemon::tools::support
