#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>

#include "engine/base/fields.hpp"

namespace yuragi::daemon::settings {

/// [recording]: where readings are recorded, and how much of that is kept.
struct RecordingConfig {
  std::optional<std::filesystem::path> file = {};  ///< nullopt: not recorded, unless --record is given
  bool is_daily = false;                           ///< a file for each day (UTC)
  std::uint64_t most_file_bytes = 0;               ///< a new file is begun beyond; 0: never
  std::int64_t keep_days = 0;                      ///< completed files that ended longer ago are deleted; 0: none
  std::uint64_t most_bytes = 0;                    ///< of all its files: the oldest are deleted beyond; 0: no limit
  std::uint64_t least_free_bytes = 0;  ///< on the disk: the oldest are deleted below, and then nothing is recorded
};

const Fields<RecordingConfig>& recording_fields();

}  // namespace yuragi::daemon::settings
