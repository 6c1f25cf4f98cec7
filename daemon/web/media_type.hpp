#pragma once

#include <filesystem>
#include <optional>
#include <string_view>

namespace yuragi::daemon::web {

/// What a browser is to take a file for, by the extension of its name, in any case; nullopt if that is not known.
std::optional<std::string_view> media_type_of(const std::filesystem::path& file);

}  // namespace yuragi::daemon::web
