#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "engine/base/result.hpp"

namespace yuragi {

/// Gives a configuration file a new text: as a whole or not at all. The new text is proven first (it is read as the
/// daemon would read it, and each sensor that could be made of the old one can be made of it); the old one is kept as
/// FILE.bak. Permissions stay, and a link goes on pointing at its file.
///
/// `old_text` is what the new one was made from: where the file says something else by now, somebody has changed it
/// meanwhile, and it is left alone. Answers where the old text is; after a Failure the file is as it was.
Result<std::filesystem::path, Failure> replace_config(const std::filesystem::path& file, std::string_view old_text,
                                                      std::string_view new_text);

}  // namespace yuragi
