#pragma once

#include <filesystem>
#include <optional>

#include "daemon/recording/clock_judge.hpp"

namespace yuragi::daemon::recording {

/// The file beside a recording that keeps a doubt of the clock from one start to the next. It exists while the clock
/// is doubted.
std::filesystem::path clock_doubt_file(const std::filesystem::path& recording);

/// Nullopt if the file does not exist, or contains no doubt that ClockJudge could have written.
std::optional<ClockDoubt> read_clock_doubt(const std::filesystem::path& file);

/// Replaces the file as a whole, and waits for the disk; removes it without a doubt. Returns false if that fails.
bool write_clock_doubt(const std::filesystem::path& file, const std::optional<ClockDoubt>& doubt);

}  // namespace yuragi::daemon::recording
