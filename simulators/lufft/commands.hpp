#pragma once

#include <CLI/CLI.hpp>

namespace yuragi::simulators::lufft {

/// Adds the subcommand of this room. main() reports the exceptions of its callback.
void add_umb_command(CLI::App& app);

}  // namespace yuragi::simulators::lufft
