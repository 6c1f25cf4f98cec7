#pragma once

#include <cstddef>
#include <filesystem>

#include "engine/base/result.hpp"
#include "engine/base/secret.hpp"

namespace yuragi::platform {

inline constexpr std::size_t kMaxSecretFile = 4096;  ///< bytes

/// Reads the one line of a file, without its line end, for example a file that systemd's LoadCredential= puts into
/// $CREDENTIALS_DIRECTORY. Fails if the file cannot be read, is not a regular file, is longer than kMaxSecretFile, is
/// empty, or has several lines or a zero byte. The failure contains nothing of its content.
Result<Secret, Failure> secret_in_file(const std::filesystem::path& file);

}  // namespace yuragi::platform
