#pragma once

#include <filesystem>

#include "engine/base/result.hpp"
#include "engine/base/secret.hpp"

namespace yuragi::viewer {

/// Returns the token in a file: its one line, without the line end. Fails if the file cannot be read, is no regular
/// file or is too long, or its content is not one line. The failure shows nothing of its content.
Result<Secret, Failure> token_in_file(const std::filesystem::path& file);

/// Returns the token that the viewer shows to the daemon: that of the file which the environment variable
/// YURAGI_TOKEN_FILE names; empty if it names none. A file that cannot be read is reported on standard error, and the
/// token is empty: the wall shows its picture all the same.
Secret own_token();

}  // namespace yuragi::viewer
