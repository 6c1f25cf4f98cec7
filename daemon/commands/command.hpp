#pragma once

#include <span>

#include <CLI/CLI.hpp>

namespace yuragi::daemon::commands {

/// One subcommand of `yuragi`: a constant `kXCommand` in its own file, listed in daemon/CMakeLists.txt.
struct Command {
  /// Adds the subcommand, its options and a callback that does the work. A callback that fails throws ExitError
  /// (exit.hpp) or any other exception (exit code 70 with its text); main catches once.
  void (*add)(CLI::App& app);
};

/// Every subcommand, in the order of the help (generated).
std::span<const Command* const> command_table();

}  // namespace yuragi::daemon::commands
