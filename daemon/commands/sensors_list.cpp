// `yuragi sensors list`: lists the devices that are plugged in, and how to configure them.
#include <fmt/core.h>

#include "daemon/commands/sensors.hpp"
#include "daemon/tools/sensors/device_list.hpp"

namespace yuragi::daemon::commands {

void add_sensors_list(CLI::App& sensors) {
  CLI::App* command =
      sensors.add_subcommand("list", "list the devices that are plugged in, and their lines for the configuration");
  command->footer(
      "Each driver looks for its devices, and opens none for longer than necessary, so that a running daemon is "
      "not\ndisturbed. If a permission is missing, the udev rule or group that grants it is shown.");
  command->callback([] {
    fmt::print("{}Devices on a serial line or behind a Modbus gateway: `yuragi sensors probe modbus PORT|HOST:PORT`.\n",
               tools::sensors::device_list(tools::sensors::find_devices(drivers::sensor::driver_table()),
                                           drivers::sensor::driver_table()));
  });
}

}  // namespace yuragi::daemon::commands
