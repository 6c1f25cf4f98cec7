#pragma once

#include <filesystem>
#include <string_view>
#include <vector>

#include "engine/base/result.hpp"
#include "engine/base/secret.hpp"

namespace yuragi::drivers::json {

/// The headers of a request in a text, a line "Name: value" each; empty lines and those that begin with "#" are
/// skipped. At most 16. The failure has the line's number and nothing of its content. Thread-safe: yes.
Result<std::vector<Secret>, Failure> headers_of(std::string_view text);

/// The same of a file of at most 4096 bytes. The failure names the file.
Result<std::vector<Secret>, Failure> headers_in_file(const std::filesystem::path& file);

}  // namespace yuragi::drivers::json
