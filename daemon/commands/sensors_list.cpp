// `yuragi sensors list`: what is plugged in, and how to use it.
#include <fmt/core.h>

#include "daemon/commands/sensors.hpp"
#include "daemon/tools/sensors/device_list.hpp"

namespace yuragi {

void add_sensors_list(CLI::App& sensors) {
  CLI::App* command = sensors.add_subcommand("list", "what is plugged in, and what to write into the configuration");
  command->footer(
      "Each driver looks for its devices; none is opened for longer than it takes to look at it, so that a running\n"
      "daemon is not disturbed. Where a permission is missing, the udev rule or the group that gives it is told.");
  command->callback([] {
    fmt::print(
        "{}What answers on a serial line or behind a Modbus gateway: `yuragi sensors probe modbus PORT|HOST:PORT`.\n",
        device_list(find_devices(driver_table()), driver_table()));
  });
}

}  // namespace yuragi
