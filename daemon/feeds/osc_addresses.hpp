#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/values/moment.hpp"

namespace yuragi::daemon::feeds {

/// A name as a part of an OSC address: each character other than A-Z a-z 0-9 _ - becomes _. The name is UTF-8.
std::string osc_part_of(std::string_view name);

/// Names as parts of OSC addresses, no two alike: a second "roof" is "roof_2".
std::vector<std::string> osc_parts_of(const std::vector<std::string>& names);

}  // namespace yuragi::daemon::feeds
