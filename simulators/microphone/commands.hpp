#pragma once

#include <CLI/CLI.hpp>

namespace yuragi::simulators::microphone {

/// Adds the subcommand of this room. main() reports the exceptions of its callback.
void add_microphone_command(CLI::App& app);

}  // namespace yuragi::simulators::microphone
