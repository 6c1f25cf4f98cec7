#pragma once

#include <string>

#include <nlohmann/json.hpp>

#include "engine/base/result.hpp"
#include "engine/base/secret.hpp"

namespace yuragi::daemon::commands {

/// A request to the daemon of this machine by HTTP.
struct PageRequest {
  std::string listen = {};  ///< "HOST:PORT", as [http] listen has it; 0.0.0.0 and :: mean this machine
  std::string path = {};    ///< "/api/v1/sessions"
  std::string body = {};    ///< JSON to POST; empty: GET
  Secret token = {};
  /// [http] certificate: the daemon answers by TLS, and must have it or one that it vouches for; empty: in the clear.
  std::string certificate = {};
};

/// Returns the JSON that the daemon answers. Throws FailureError (kUnavailable) if none answers within 10 s, or its
/// answer is not JSON of at most 1 MiB, and ExitError with the daemon's reason if it refuses the request.
nlohmann::json ask_page(const PageRequest& request);

}  // namespace yuragi::daemon::commands
