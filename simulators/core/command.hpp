#pragma once

#include <span>

namespace CLI {
class App;
}

namespace yuragi::simulators::core {

/// A subcommand of yuragi-sim: one constant `kXCommand` in its own file, listed in its folder's CMakeLists.txt.
struct Command {
  /// Adds itself. main() reports the exceptions of its callback.
  void (*add)(CLI::App& app);
};

/// Every subcommand (generated).
std::span<const Command* const> command_table();

}  // namespace yuragi::simulators::core
