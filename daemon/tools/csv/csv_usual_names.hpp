#pragma once

#include <span>
#include <string_view>

#include "daemon/tools/csv/csv_role.hpp"

namespace yuragi::daemon::tools::csv {

/// What loggers, stations and archives commonly call a column of this role, as Name::stem; the first that is found
/// is used. Sources: drivers/SOURCES.md S12.
std::span<const std::string_view> usual_names(Role role);

}  // namespace yuragi::daemon::tools::csv
