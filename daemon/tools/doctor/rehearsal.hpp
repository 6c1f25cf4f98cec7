#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "daemon/settings/config.hpp"
#include "daemon/tools/doctor/finding.hpp"
#include "daemon/tools/doctor/service_facts.hpp"
#include "daemon/tools/doctor/service_unit.hpp"
#include "daemon/tools/sensors/device_list.hpp"

namespace yuragi::daemon::tools::doctor {

/// The next start of the daemon, to be tried without it.
struct Rehearsal {
  const settings::Config& config;
  std::filesystem::path config_file{};
  ServiceUnit unit{};
  /// What the drivers have found (plugged_devices()); nullopt: not searched, and USB devices are passed over.
  std::optional<std::span<const sensors::DeviceFinding>> plugged{};
  std::vector<std::string> own_addresses{};  ///< where the daemon that asks listens itself
};

/// Searches for the USB devices that the configuration names, for Rehearsal::plugged; opens each that is found.
std::vector<sensors::DeviceFinding> plugged_devices(const settings::Config& config);

/// The paths that the service will use, not yet looked at: the configuration, token, pictures, recordings, profiles,
/// keys and devices. Relative ones begin where the service would look. Pure.
std::vector<PathFacts> named_paths(const Rehearsal& rehearsal);

/// Inspects a path and each folder above it. Opens nothing.
void look_at(PathFacts& path);

/// What the configuration will meet in the unit: errors and warnings; none if all is well. Opens no device and no file;
/// listens at each address for a moment. Looks up names of users and groups: on one thread at a time.
std::vector<Finding> rehearse_configuration(const Rehearsal& rehearsal);

/// What a daemon that runs with one configuration and reads another one would meet with it at its next start: as its
/// unit if that is installed and names this file, else as this process. Texts, each with how to fix it.
std::vector<std::string> next_start_warnings(const settings::Config& running, const settings::Config& next,
                                             const std::string& config_file);

/// The same, with the programs, the viewer's unit if it is enabled, and the monitors. At least one finding. Takes up to
/// 5 s for each program.
std::vector<Finding> rehearse(const Rehearsal& rehearsal);

}  // namespace yuragi::daemon::tools::doctor
