#pragma once

#include <CLI/CLI.hpp>

namespace yuragi::simulators::text {

// Each adds one subcommand. main() reports the exceptions of the callbacks.
void add_line_command(CLI::App& app);
void add_nmea_command(CLI::App& app);
void add_nmea2000_command(CLI::App& app);
void add_signalk_command(CLI::App& app);

}  // namespace yuragi::simulators::text
