#pragma once

#include <filesystem>
#include <string>

#include "engine/base/secret.hpp"

namespace yuragi::daemon::settings {

/// Where the package puts the configuration of the service.
inline constexpr const char* kServiceConfig = "/etc/yuragi/yuragi.toml";

/// The token that a command shows to a daemon.
struct OwnToken {
  Secret token;      ///< empty: there is none
  std::string hint;  ///< if the file of the service's token cannot be read by this user: which group may. Else empty.
};

/// Returns the token for the daemon at `address` ("HOST:PORT"): that of the file which the environment variable
/// YURAGI_TOKEN_FILE names, or, for a daemon of this machine, that of [http] token_file in `config`. The service's own
/// configuration is the default. Throws FailureError if the file of the environment variable cannot be read.
OwnToken own_token(const std::string& address, const std::filesystem::path& config = kServiceConfig);

}  // namespace yuragi::daemon::settings
