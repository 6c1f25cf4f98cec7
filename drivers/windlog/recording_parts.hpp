#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "engine/base/time.hpp"

namespace yuragi::drivers::windlog {

// A recording can be a series of files: wall.windlog is the one that is being written, and the completed ones lie
// beside it, each with the moment of its beginning (UTC) in its name: wall-20261123T000000Z.windlog.

/// The name of a completed part of a recording that began at a moment.
std::filesystem::path part_name(const std::filesystem::path& recording, UtcTime begin);

/// Returns the moment in the name of a part of `recording`; nullopt for any other file.
std::optional<UtcTime> begin_of_part(const std::filesystem::path& recording, const std::filesystem::path& file);

struct RecordingPart {
  std::filesystem::path file;
  UtcTime begin;
};

/// The completed parts of a recording, oldest first; none if the folder cannot be read.
std::vector<RecordingPart> completed_parts(const std::filesystem::path& recording);

/// The files of a recording: its completed parts, oldest first, and the file that may still grow, if it exists.
std::vector<std::filesystem::path> recording_files(const std::filesystem::path& recording);

/// Returns true if there is such a recording: the file, or a completed part of it.
bool recording_exists(const std::filesystem::path& recording);

}  // namespace yuragi::drivers::windlog
