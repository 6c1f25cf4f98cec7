#pragma once

#include <string>
#include <vector>

#include "daemon/settings/config.hpp"
#include "daemon/tools/doctor/facts.hpp"

namespace yuragi::daemon::tools::doctor {

// Each function inspects one thing of this machine, and changes nothing. What cannot be inspected is returned as
// unknown.

/// Bytes of a recording for each reading, its index included.
inline constexpr double kBytesPerReading = 48.0;

GroupFacts probe_groups(std::vector<std::string> needed_groups);
ClockFacts probe_clock(const settings::Config& config);
/// `readings_per_s`: of all sensors that are recorded.
DiskFacts probe_disk(const settings::RecordingConfig& recording, double readings_per_s);
/// `daemon`: who answers there.
PortFacts probe_port(const std::string& address, const std::string& daemon);
DisplayFacts probe_display();
VersionFacts probe_versions(const std::string& daemon, const std::optional<std::string>& viewer);
LimitFacts probe_limits(const settings::Config& config);

}  // namespace yuragi::daemon::tools::doctor
