#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "daemon/settings/config.hpp"
#include "daemon/tools/doctor/facts.hpp"
#include "daemon/tools/sensors/device_list.hpp"
#include "engine/base/time.hpp"
#include "engine/wire/wire.hpp"

namespace yuragi::daemon::tools::doctor {

/// The devices that a sensor's configuration names, not yet inspected: two for a vane on a line of its
/// own. Pure.
std::vector<DeviceFacts> named_devices(const settings::SensorConfig& sensor);

/// Returns true if `found`, which a driver has found, can be the device that this sensor's configuration chooses. Only
/// keys that both give are compared; a sound card is chosen by a part of its name, in any case. Pure.
bool is_chosen(const settings::SensorConfig& sensor, const sensors::DeviceFinding& found);

/// The groups that open the devices of a configuration: dialout, plugdev, audio. Pure.
std::vector<std::string> needed_groups(const settings::Config& config);

/// Looks for every device of a configuration. `plugged`: what the drivers have found (find_devices()). Devices of a
/// sensor from which the running daemon has readings are not touched. Waits for a network device for `timeout` at most.
std::vector<DeviceFacts> probe_devices(const settings::Config& config, std::span<const sensors::DeviceFinding> plugged,
                                       const std::optional<wire::Sensors>& running, Nanoseconds timeout);

}  // namespace yuragi::daemon::tools::doctor
