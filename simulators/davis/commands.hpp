#pragma once

#include <CLI/CLI.hpp>

namespace yuragi::simulators::davis {

// Each adds one subcommand. main() reports the exceptions of the callbacks.
void add_davis_command(CLI::App& app);
void add_weatherlink_live_command(CLI::App& app);

}  // namespace yuragi::simulators::davis
