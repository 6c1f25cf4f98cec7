#pragma once

#include <string>

namespace yuragi::daemon::settings {

/// "0.4 s", "12 min 5 s", "3 h 20 min", "41 days 6 h".
std::string duration_text(double duration_s);

}  // namespace yuragi::daemon::settings
