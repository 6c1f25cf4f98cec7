#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "daemon/settings/config.hpp"

namespace yuragi::daemon::settings {

/// Can everybody on this machine read it? By its mode alone; false if it cannot be looked at.
bool is_read_by_everybody(const std::filesystem::path& file);

/// What others on this machine can read of the secrets of a configuration that was loaded from `file`: a sentence for
/// each secret that stands in it, if everybody can read that file, and for each file of a secret that everybody can
/// read. It begins with the place, names the file, and has the command that fixes it; it shows no secret. Who may read
/// a file is taken from its mode alone. Files that cannot be looked at are passed over.
std::vector<std::string> exposed_secrets(const Config& config, const std::filesystem::path& file);

}  // namespace yuragi::daemon::settings
