#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string_view>

#include "engine/base/parameter.hpp"

namespace yuragi::daemon::settings {

/// When a new file is begun: [recording] rotate.
inline constexpr std::array<std::string_view, 2> kRotationNames = {"never", "day"};

/// [recording]: where readings are recorded, and how much of that is kept.
struct RecordingConfig {
  std::optional<std::filesystem::path> file = {};  ///< nothing: not recorded, unless the command line says so
  bool is_daily = false;                           ///< a file for each day (UTC)
  std::uint64_t most_file_bytes = 0;               ///< a new file is begun beyond; 0: never
  std::int64_t keep_days = 0;                      ///< completed files that ended longer ago are deleted; 0: none
  std::uint64_t most_bytes = 0;                    ///< of all its files: the oldest are deleted beyond; 0: no limit
  std::uint64_t least_free_bytes = 0;  ///< on the disk: the oldest are deleted below, and then nothing is recorded
};

/// From the values of recording_parameters().
RecordingConfig recording_config_of(const ParameterValues& values);

}  // namespace yuragi::daemon::settings
