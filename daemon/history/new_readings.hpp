#pragma once

#include <cstddef>
#include <filesystem>
#include <stop_token>

#include "daemon/history/means_file.hpp"
#include "engine/base/result.hpp"

namespace yuragi::daemon::history {

/// Adds the readings of a recording, or a series of them, that are not yet in its means: all of them the first time,
/// then only what came since. Completed files that are in it already are not opened. A reading counts in the step that
/// its UTC names, once, however the clock was set. Memory is bounded; `stop` ends it within milliseconds with a
/// failure, and what was added stays.
///
/// Returns the number of files that are damaged or cannot be opened; they are left out. Fails with kNoInput if there is
/// no file, and with kBadData if the means are damaged. Realtime-safe: no; waits for the disk.
Result<std::size_t, Failure> add_new_readings(const std::filesystem::path& recording, MeansFile& means,
                                              const std::stop_token& stop);

}  // namespace yuragi::daemon::history
