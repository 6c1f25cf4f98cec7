#pragma once

#include <CLI/CLI.hpp>

namespace yuragi::simulators::network {

// Each adds one subcommand. main() reports the exceptions of the callbacks.
void add_ecowitt_command(CLI::App& app);
void add_ecowitt_push_command(CLI::App& app);
void add_osc_command(CLI::App& app);
void add_tempest_command(CLI::App& app);

}  // namespace yuragi::simulators::network
