#pragma once

#include <CLI/CLI.hpp>

namespace yuragi::sim {

// Each adds one kind of simulator as a subcommand, from a file of its own. main() reports the exceptions of the
// callbacks.

void add_microphone_command(CLI::App& app);
void add_modbus_command(CLI::App& app);
void add_nmea_command(CLI::App& app);
void add_line_command(CLI::App& app);
void add_hid_command(CLI::App& app);
void add_usb_command(CLI::App& app);
void add_recording_command(CLI::App& app);

}  // namespace yuragi::sim
