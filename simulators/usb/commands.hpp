#pragma once

#include <CLI/CLI.hpp>

namespace yuragi::simulators::usb {

// Each adds one subcommand. main() reports the exceptions of the callbacks.
void add_hid_command(CLI::App& app);
void add_usb_command(CLI::App& app);

}  // namespace yuragi::simulators::usb
