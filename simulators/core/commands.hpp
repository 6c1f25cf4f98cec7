#pragma once

#include <CLI/CLI.hpp>

namespace yuragi::simulators::core {

// Each adds one subcommand. main() reports the exceptions of the callbacks.
void add_recording_command(CLI::App& app);
void add_scenario_command(CLI::App& app);

}  // namespace yuragi::simulators::core
