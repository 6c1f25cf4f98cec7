#pragma once

#include "daemon/settings/config.hpp"

namespace yuragi::daemon::service {

/// Throws ConfigError for what a Service would refuse in a configuration, without opening a device, an address or a
/// recording to write.
void check(const settings::Config& config);

/// Throws ConfigError where a daemon that runs with one configuration could not be started with another, as far as that
/// can be told while it runs. What has not changed is not asked for again: a recording that plays may be on a disk that
/// is away.
void check_restart(const settings::Config& running, const settings::Config& wanted);

}  // namespace yuragi::daemon::service
