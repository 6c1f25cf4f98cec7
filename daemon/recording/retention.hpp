#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

#include "daemon/settings/recording_config.hpp"
#include "engine/base/time.hpp"

namespace yuragi::daemon::recording {

// How much of a recording is kept. Pure.

/// Returns true if a file of this beginning and size is to be completed and a new one begun. A daily one also if the
/// clock has been set back to before its beginning, because that day may be far away.
bool is_complete(const settings::RecordingConfig& rules, UtcTime begin, std::uint64_t bytes, UtcTime now);

/// The maximum growth of a recording between two checks of its size: SQLite's log beside the file (1000 pages of 4 KiB
/// until they are moved into it) and the file itself, with room to spare.
inline constexpr std::uint64_t kGrowthBetweenLooks_bytes = 8'000'000;

/// The same rules with their limits tightened by kGrowthBetweenLooks_bytes, so that the limits hold until the next
/// look, too; a total size by a quarter of itself at most.
settings::RecordingConfig with_room_to_grow(settings::RecordingConfig rules);

/// A completed file of a recording.
struct KeptPart {
  std::filesystem::path file;
  UtcTime begin;
  std::uint64_t bytes = 0;
};

/// Age deletes at most this many completed files for each one that is completed, at any date.
inline constexpr std::size_t kMaxDeletedByAge = 2;

/// A completed file that is to be deleted.
struct PartToDelete {
  std::filesystem::path file;
  bool is_by_age = false;  ///< otherwise by the limits of size and free space
};

/// Those of the completed files (given oldest first) that are to be deleted, oldest first: at most `max_by_age` because
/// they are too old, and those that are more than the limits of size and free space allow. `written_bytes`: of the
/// file that is being written, which is never deleted.
std::vector<PartToDelete> parts_to_delete(const settings::RecordingConfig& rules, std::span<const KeptPart> parts,
                                          std::uint64_t written_bytes, std::uint64_t free_bytes, UtcTime now,
                                          std::size_t max_by_age);

}  // namespace yuragi::daemon::recording
