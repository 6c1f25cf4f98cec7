#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "engine/base/result.hpp"
#include "engine/base/time.hpp"

namespace yuragi::drivers::windlog {

/// One file of a series, as verify_recording() found it.
struct VerifiedFile {
  std::filesystem::path file;
  std::uint64_t readings = 0;
  std::size_t sessions = 0;                ///< with readings
  std::size_t sessions_without_count = 0;  ///< of these: not closed (yet), or of an older program
  std::optional<UtcTime> first;            ///< the earliest and the latest reading
  std::optional<UtcTime> last;
  std::vector<std::string> damage;  ///< sentences; empty: sound
};

/// No reading of a sensor for longer than was asked for.
struct RecordingGap {
  std::string sensor;
  UtcTime from;  ///< the reading before it
  UtcTime to;    ///< the reading after it
  Nanoseconds length{0};
};

struct Verification {
  std::vector<VerifiedFile> files;             ///< oldest first
  std::vector<std::filesystem::path> missing;  ///< files that others of the series name, and that are missing
  std::vector<RecordingGap> gaps;

  bool is_sound() const;
};

/// Reads a whole series (recording_parts.hpp) and checks it against itself: of each file that SQLite finds its pages
/// and references sound, that its times ascend, that each row is a reading of a sensor of a session, and that the
/// readings of each session are those that it counted when it was closed; of the series that no file is missing between
/// two. Lists gaps longer than `max_gap`; they are no damage. A series that is being recorded can be verified: each
/// file is read as it is at one moment.
///
/// Fails (kNoInput) if the recording does not exist; damage is not a failure. Realtime-safe: no.
Result<Verification, Failure> verify_recording(const std::filesystem::path& recording, Nanoseconds max_gap);

}  // namespace yuragi::drivers::windlog
