#pragma once

#include <cstddef>
#include <filesystem>

#include "engine/base/result.hpp"
#include "engine/base/secret.hpp"

namespace yuragi::platform {

inline constexpr std::size_t kMaxSecretFile = 4096;  ///< bytes

/// The one line of a file, without its line end. It is what systemd's LoadCredential= leaves in
/// $CREDENTIALS_DIRECTORY, for example. Fails where the file cannot be read, is no regular file, is longer than
/// kMaxSecretFile, or holds nothing, several lines or a zero byte. The failure shows nothing of its content.
Result<Secret, Failure> secret_in_file(const std::filesystem::path& file);

}  // namespace yuragi::platform
