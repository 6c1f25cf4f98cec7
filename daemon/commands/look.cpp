// `yuragi look`: lists and sets light and weather of a running daemon.
#include "daemon/commands/command.hpp"
#include "daemon/commands/parameter_commands.hpp"

namespace yuragi::daemon::commands {
namespace {

void add_look_command(CLI::App& app) {
  CLI::App* look = app.add_subcommand("look", "list and set the light and the weather of a running daemon");
  look->require_subcommand(1);
  look->footer(
      "  yuragi look values                       all values, and those of the configuration where they differ\n"
      "  yuragi look set haze=0.4 time=06:30      the viewers cross-fade to it\n"
      "  yuragi look reset                        all as in the configuration\n"
      "Exit code 0: done; 64: a mistake in a key or a value; 69: no daemon replies; 77: the daemon does not allow it\n"
      "from here (see `yuragi describe`, [stream] control).");
  add_parameter_commands(*look, false);
}

}  // namespace

extern const Command kLookCommand;
const Command kLookCommand{add_look_command};

}  // namespace yuragi::daemon::commands
