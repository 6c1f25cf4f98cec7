#pragma once

#include <string>

#include "daemon/http/server.hpp"

namespace yuragi::daemon::web {

/// Why a request was not answered, for a program and a person (M. Nottingham and others, RFC 9457, "Problem Details for
/// HTTP APIs", 2023).
http::Response problem(unsigned status, std::string title, std::string detail);

}  // namespace yuragi::daemon::web
