#pragma once

#include <CLI/CLI.hpp>

namespace yuragi::daemon::commands {

/// Adds `values`, `set` and `reset`, which list and change the values of a running daemon. `of_scenes`: of its scenes,
/// each by its name; otherwise of [look].
void add_parameter_commands(CLI::App& command, bool of_scenes);

}  // namespace yuragi::daemon::commands
