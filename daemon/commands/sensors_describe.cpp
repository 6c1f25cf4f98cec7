// `yuragi sensors describe`: describes drivers and their parameters.
#include <algorithm>
#include <memory>

#include <fmt/format.h>

#include "daemon/commands/exit.hpp"
#include "daemon/commands/json_output.hpp"
#include "daemon/commands/sensors.hpp"
#include "daemon/tools/sensors/description_json.hpp"
#include "daemon/tools/sensors/driver_reference.hpp"

namespace yuragi::daemon::commands {
namespace {

struct DescribeOptions {
  std::string driver;
  bool all = false;
  bool as_json = false;
};

void describe(const DescribeOptions& options) {
  const auto drivers = drivers::sensor::driver_table();
  if (options.all && !options.as_json) {
    fmt::print("{}", tools::sensors::driver_reference(drivers));
  } else if (options.driver.empty() && options.as_json) {
    print_json(tools::sensors::drivers_json(drivers));
  } else if (options.driver.empty()) {
    fmt::print(
        "{}\n"
        "`yuragi sensors describe DRIVER` lists the keys of each.\n",
        tools::sensors::driver_names(drivers));
  } else {
    const auto found = std::ranges::find_if(
        drivers, [&](const drivers::sensor::DriverDescription* driver) { return driver->name == options.driver; });
    if (found == drivers.end()) {
      throw ExitError(kExitUsage, fmt::format("there is no driver \"{}\"; there are:\n{}", options.driver,
                                              tools::sensors::driver_names(drivers)));
    }
    if (options.as_json) return print_json(tools::sensors::drivers_json(std::span(&*found, 1)));
    fmt::print("{}", tools::sensors::describe_driver(**found));
  }
}

}  // namespace

void add_sensors_describe(CLI::App& sensors) {
  CLI::App* command =
      sensors.add_subcommand("describe", "list the drivers, or the keys of one: unit, range, default, help");
  auto options = std::make_shared<DescribeOptions>();
  CLI::Option* driver = command->add_option("driver", options->driver, "which driver; default: a list of all");
  driver->option_text("[DRIVER]");
  command->add_flag("--all", options->all, "every driver, as a page of Markdown")->excludes(driver);
  add_json(*command, options->as_json);
  command->footer(
      "--json: a list with name, summary, parameters, known_devices, device_setup (what to set at the device) for each "
      "driver;\n"
      "of a parameter name, type, unit, default, left_out (what it means if it is left out), min, max, choices, "
      "help;\n"
      "of a device name, device, confirmed_by, unconfirmed, value (what its speed is: value, averaging_s, source; "
      "null: "
      "unknown).");
  command->callback([options] { describe(*options); });
}

}  // namespace yuragi::daemon::commands
