#pragma once

#include <filesystem>
#include <optional>
#include <utility>

#include "daemon/commands/exit.hpp"
#include "drivers/windlog/series_lock.hpp"

namespace yuragi::daemon::commands {

/// Takes the lock of a recording that a command is to write. Throws ExitError (kExitUnavailable) if another program
/// records to it. Nullopt if the lock cannot be created: then neither can the recording, which is reported with it.
inline std::optional<drivers::windlog::SeriesLock> lock_recording(const std::filesystem::path& recording) {
  auto lock = drivers::windlog::SeriesLock::take(recording);
  if (lock) return std::move(*lock);
  if (lock.error().kind == FailureKind::kUnavailable) throw ExitError(kExitUnavailable, lock.error().message);
  return std::nullopt;
}

}  // namespace yuragi::daemon::commands
