#pragma once

#include <vector>

#include "daemon/tools/doctor/finding.hpp"
#include "daemon/tools/doctor/service_facts.hpp"
#include "daemon/tools/doctor/service_unit.hpp"

namespace yuragi::daemon::tools::doctor {

// What the program of a unit will meet, independent of the current user. Each returns findings for what is wrong, and
// none otherwise. Pure.

/// The unit itself: its user and its groups.
std::vector<Finding> judge(const ServiceUnit& unit);
std::vector<Finding> judge(const PathFacts& path, const ServiceUnit& unit);
std::vector<Finding> judge(const ListenFacts& listen, const ServiceUnit& unit);
std::vector<Finding> judge(const ProgramFacts& program, const ServiceUnit& unit);
std::vector<Finding> judge(const MonitorFacts& monitor);

}  // namespace yuragi::daemon::tools::doctor
