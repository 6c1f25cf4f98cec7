#pragma once

#include <CLI/CLI.hpp>

namespace yuragi::daemon::commands {

// The subcommands of `yuragi sensors`: each is added by the file of its name.
void add_sensors_list(CLI::App& sensors);
void add_sensors_probe(CLI::App& sensors);
void add_sensors_describe(CLI::App& sensors);
void add_sensors_watch(CLI::App& sensors);
void add_sensors_try(CLI::App& sensors);

}  // namespace yuragi::daemon::commands
