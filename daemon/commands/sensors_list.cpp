// `yuragi sensors list`: lists the devices that are plugged in, and how to configure them.
#include <memory>

#include <fmt/core.h>

#include "daemon/commands/json_output.hpp"
#include "daemon/commands/sensors.hpp"
#include "daemon/tools/sensors/description_json.hpp"
#include "daemon/tools/sensors/device_list.hpp"

namespace yuragi::daemon::commands {

void add_sensors_list(CLI::App& sensors) {
  CLI::App* command =
      sensors.add_subcommand("list", "list the devices that are plugged in, and their lines for the configuration");
  command->footer(
      "Each driver looks for its devices, and opens none for longer than necessary, so that a running daemon is "
      "not\ndisturbed. If a permission is missing, the udev rule or group that grants it is shown.\n"
      "--json: a list with driver, device, settings (TOML to paste), trouble and remedy (null where it can be "
      "opened).");
  auto as_json = std::make_shared<bool>(false);
  add_json(*command, *as_json);
  command->callback([as_json] {
    const auto drivers = drivers::sensor::driver_table();
    const std::vector<tools::sensors::DeviceFinding> findings = tools::sensors::find_devices(drivers);
    if (*as_json) return print_json(tools::sensors::devices_json(findings));
    fmt::print("{}Devices on a serial line or behind a Modbus gateway: `yuragi sensors probe modbus PORT|HOST:PORT`.\n",
               tools::sensors::device_list(findings, drivers));
  });
}

}  // namespace yuragi::daemon::commands
