// `yuragi sensors`: lists devices, describes drivers, and shows readings.
#include "daemon/commands/sensors.hpp"

#include "daemon/commands/command.hpp"

namespace yuragi::daemon::commands {
namespace {

void add_sensors(CLI::App& app) {
  CLI::App* sensors = app.add_subcommand("sensors", "find, set up and watch sensors");
  sensors->require_subcommand(1);
  add_sensors_list(*sensors);
  add_sensors_probe(*sensors);
  add_sensors_describe(*sensors);
  add_sensors_watch(*sensors);
  add_sensors_try(*sensors);
}

}  // namespace

extern const Command kSensorsCommand;
const Command kSensorsCommand{add_sensors};

}  // namespace yuragi::daemon::commands
