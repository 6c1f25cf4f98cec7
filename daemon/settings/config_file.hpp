#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "engine/base/result.hpp"

namespace yuragi::daemon::settings {

/// The absolute path of a file without "." and "..", by which two programs on a machine know that they mean the same
/// one. Links are not followed: what they lead to may change.
std::string absolute_path(const std::filesystem::path& file);

/// Returns the file NAME in which something outlives the daemon: in the folder that systemd provides (STATE_DIRECTORY),
/// otherwise CONFIG.NAME beside the configuration. Empty if there is neither.
std::filesystem::path state_file(const std::filesystem::path& config_file, std::string_view name);

/// Replaces the text of a configuration file, as a whole or not at all. The new text is checked first: it must parse,
/// and every sensor that could be constructed from the old text can be constructed from it. The old text is kept as
/// FILE.bak. Permissions stay, and a symbolic link keeps pointing at its file.
///
/// `old_text` is what the new text was made from; the file is left unchanged if it has changed since. Returns the path
/// of the old text; after a Failure the file is as it was.
Result<std::filesystem::path, Failure> replace_config(const std::filesystem::path& file, std::string_view old_text,
                                                      std::string_view new_text);

}  // namespace yuragi::daemon::settings
