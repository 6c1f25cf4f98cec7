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

/// As lock_recording(), for a command that can write any kind of file: nullopt if `output` is not named as a recording.
inline std::optional<drivers::windlog::SeriesLock> lock_output(const std::filesystem::path& output) {
  return output.extension() == ".windlog" ? lock_recording(output) : std::nullopt;
}

}  // namespace yuragi::daemon::commands
