#pragma once

#include <vector>

#include "daemon/settings/wind_config.hpp"
#include "daemon/tools/doctor/facts.hpp"
#include "engine/base/time.hpp"

namespace yuragi::daemon::tools::doctor {

/// Connects to each server of [wind] lead or follow, to all at once, for `time` at most, and listens for a leader's
/// ticks. Publishes nothing.
std::vector<CompanyServerFacts> probe_company(const settings::LeadConfig& config, Nanoseconds time);

}  // namespace yuragi::daemon::tools::doctor
