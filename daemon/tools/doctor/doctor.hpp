#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/settings/config.hpp"
#include "daemon/tools/doctor/finding.hpp"
#include "daemon/tools/sensors/daemon_status.hpp"

namespace yuragi::daemon::tools::doctor {

/// What is to be examined.
struct Examination {
  std::optional<std::filesystem::path> config_file;  ///< none: the built-in configuration
  std::optional<settings::Config> config;            ///< none: it has errors
  std::string config_error;                          ///< those, a line for each
  std::optional<sensors::DaemonStatus> daemon;       ///< the one that runs; nullopt: none
};

/// Looks at the devices that the configuration names, permissions, clock, disk, ports, graphics, versions and limits of
/// this machine, and judges each. Changes nothing, and opens no device for longer than a driver's search does. Takes
/// some seconds: 2 s for each network device that does not reply. `begin_step` (can be empty) is called before each
/// part that can take long, with its name ("the sensors' devices").
std::vector<Finding> examine(const Examination& examination,
                             const std::function<void(std::string_view)>& begin_step = {});

}  // namespace yuragi::daemon::tools::doctor
