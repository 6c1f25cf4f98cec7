#pragma once

#include <string>

#include "engine/base/result.hpp"
#include "engine/base/secret.hpp"

namespace yuragi {

/// Returns the secret in the text of a file: its one line, without the line end. Fails if the text is empty, has
/// several lines or a zero byte. The failure's message states what is wrong with the file ("is empty"), without its
/// text.
Result<Secret, Failure> secret_line(std::string text);

}  // namespace yuragi
