#pragma once

#include <CLI/CLI.hpp>

namespace yuragi {

// What `yuragi sensors` can do: each adds one subcommand to it, from the file of its name.
void add_sensors_list(CLI::App& sensors);
void add_sensors_probe(CLI::App& sensors);
void add_sensors_describe(CLI::App& sensors);
void add_sensors_watch(CLI::App& sensors);

}  // namespace yuragi
