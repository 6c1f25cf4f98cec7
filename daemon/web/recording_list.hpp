#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/base/time.hpp"

namespace yuragi::daemon::web {

/// A file of this installation's recording.
struct RecordingFile {
  std::filesystem::path file = {};
  std::uint64_t bytes = 0;
  std::optional<UtcTime> first = {};  ///< its first reading; nullopt: it has none, or cannot be read
  std::optional<UtcTime> last = {};   ///< its last reading
  bool is_written = false;            ///< it may still grow
};

/// Completed files do not change: each is opened once to learn its times.
using KnownRecordings = std::map<std::filesystem::path, RecordingFile>;

/// Older ones are not listed.
inline constexpr std::size_t kMaxListedRecordings = 1000;

/// The files of a recording, newest first: the one that is written, and the completed ones beside it as
/// daemon/recording names them. `known`: what was learnt of completed files; it is brought up to date. Empty for an
/// empty path. Waits for the disk.
std::vector<RecordingFile> list_recordings(const std::filesystem::path& recording, KnownRecordings& known);

/// Returns the file of the recording that has this name; nullopt if none has. The name is only compared, and never
/// becomes a part of a path. Waits for the disk.
std::optional<RecordingFile> recording_named(const std::filesystem::path& recording, std::string_view name);

/// {"recordings": [{"name", "bytes", "first_s", "last_s", "is_written"}]}, with names but no folders. Pure.
std::string recordings_json(const std::vector<RecordingFile>& recordings);

}  // namespace yuragi::daemon::web
