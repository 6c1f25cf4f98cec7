#pragma once

#include <string_view>

namespace yuragi::daemon::web {

/// The text of openapi.json, which is compiled in.
std::string_view openapi_json();

}  // namespace yuragi::daemon::web
