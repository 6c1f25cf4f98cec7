#pragma once

#include <optional>
#include <string>

namespace yuragi::viewer::film {

/// "picture 120 of 600, 2.1 a second, 3:49 left". `total`: nothing where it is not known; `passed_s`: since the first
/// picture was begun.
std::string film_progress_text(int made, std::optional<int> total, double passed_s);

}  // namespace yuragi::viewer::film
