#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>

#include "engine/base/result.hpp"

namespace yuragi::drivers::windlog {

/// Returns the new texts of a recording; nullopt: they stay.
struct TextRewrite {
  std::function<std::optional<std::string>(const std::string& configuration)> configuration;  ///< of each session
  /// For each sensor of each session.
  std::function<std::optional<std::string>(const std::string& driver, const std::string& options)> options;
};

/// Changes the texts of a closed recording so that the bytes of the old ones are gone from the file and from what
/// stands beside it; readings and their order stay. Returns how many texts changed; if none, the file is not written
/// to, except with what a killed recorder left in FILE-wal.
///
/// Either all texts change or none, even if the process is killed or the power fails. The file is rewritten as a whole,
/// which takes as much free space again. If only that fails, the failure's text has it: then the texts are changed, and
/// traces of the old ones may be left in unused parts of the file.
///
/// Holds the SeriesLock of the file. Refuses (kUnavailable) a recording that another program records to or has open,
/// (kBadData) a file that is no recording, or one of a newer format, and (kNoInput) one that is missing.
Result<std::size_t, Failure> rewrite_texts(const std::filesystem::path& file, const TextRewrite& rewrite);

}  // namespace yuragi::drivers::windlog
