#pragma once

#include <optional>
#include <string>

namespace yuragi::viewer::film {

/// Returns "picture 120 of 600, 2.1 a second, 3:49 left". `total`: nullopt if unknown; `passed_s`: since the first
/// picture was begun.
std::string film_progress_text(int made, std::optional<int> total, double passed_s);

}  // namespace yuragi::viewer::film
