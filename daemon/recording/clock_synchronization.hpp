#pragma once

#include <filesystem>

#include "engine/base/time.hpp"

namespace yuragi::daemon::recording {

/// systemd-timesyncd sets the time of this file each time that it has set the clock by a server's, at least every 34
/// minutes (systemd-timesyncd.service(8), timesyncd.conf(5)). Any user and a confined service can look at it.
inline constexpr const char* kSynchronizedFile = "/run/systemd/timesync/synchronized";

/// Returns true if the time of `file` is at most kMaxClockStep before `now`: the clock has not jumped since it was
/// synchronized. False also means that it is not known: another program synchronizes the clock, or none does.
bool is_synchronized(const std::filesystem::path& file, UtcTime now);

}  // namespace yuragi::daemon::recording
