#pragma once

#include <CLI/CLI.hpp>

namespace yuragi::simulators::modbus {

/// Adds the subcommand of this room. main() reports the exceptions of its callback.
void add_modbus_command(CLI::App& app);

}  // namespace yuragi::simulators::modbus
