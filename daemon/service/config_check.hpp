#pragma once

#include "daemon/settings/config.hpp"

namespace yuragi::daemon::service {

/// Throws ConfigError for what a Service would refuse in a configuration, without opening a device, an address or a
/// recording to write.
void check(const settings::Config& config);

/// Throws ConfigError if a daemon that runs with one configuration could not be started with another, as far as that
/// can be checked while it runs. What has not changed is not checked again: a recording that plays may be on a disk
/// that is no longer connected.
void check_restart(const settings::Config& running, const settings::Config& wanted);

}  // namespace yuragi::daemon::service
