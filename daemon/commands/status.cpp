// `yuragi status`: how the running daemon does, and an exit code for scripts.
#include <memory>
#include <optional>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "daemon/commands/ask_daemon.hpp"
#include "daemon/commands/command.hpp"
#include "daemon/commands/exit.hpp"
#include "daemon/commands/installation.hpp"
#include "daemon/commands/json_output.hpp"
#include "daemon/commands/run_options.hpp"
#include "daemon/commands/slow_notice.hpp"
#include "daemon/settings/standard_output.hpp"
#include "daemon/state/attention.hpp"

namespace yuragi::daemon::commands {
namespace {

struct StatusOptions {
  std::optional<std::filesystem::path> config_file;
  std::optional<std::string> address;
  bool as_json = false;
  bool is_quiet = false;

  std::string daemon_address() const {
    if (address) return *address;
    return (config_file ? settings::load_config(*config_file) : settings::default_config()).stream.listen;
  }
};

void show_daemon_status(const StatusOptions& options) {
  const std::string address = options.daemon_address();
  std::optional<SlowNotice> notice;
  if (!options.is_quiet) notice.emplace(fmt::format("waiting for the daemon at {}, for some seconds", address));
  const auto status = ask_daemon(address, "status");
  notice.reset();
  if (!status) {
    if (options.as_json)
      print_json({{"verdict", "no daemon"}, {"address", address}, {"error", status.error().message}});
    throw ExitError(kExitNoDaemon, status.error().message);
  }
  if (options.as_json) {
    print_json(tools::sensors::status_json(*status));
  } else if (!options.is_quiet) {
    settings::write_at_once(tools::sensors::status_text(*status));
  }
  if (!state::needs_attention(status->sensors).empty()) throw ExitError(kExitAttention, "");
}

void add_status(CLI::App& app) {
  CLI::App* command = app.add_subcommand("status", "show how the running daemon does, with an exit code for scripts");
  command->footer(
      "Exit code 0: all is well; 1: it runs, but something needs attention; 2: no daemon replies (also the codes of\n"
      "a Nagios check); 64: wrong command line; 78: a mistake in the configuration.\n"
      "These need attention: a sensor whose readings are not used (connecting, stale, frozen, seized, implausible,\n"
      "disconnected); a recorder that cannot write, whose disk does not respond, that has dropped readings or has\n"
      "less than 200 MB left; lateness: 1 % of the ticks late by more than 17 ms, or of the steps of sensors and\n"
      "clients by more than 100 ms. The running time is that of the animation; without scenes it is unknown.\n"
      "A scene's part of a tick, and what this machine can carry (up to half of each tick), are means of the last\n"
      "5 s. On the daemon's machine this works even if the maximum number of clients is connected.\n"
      "  yuragi status --connect 192.168.1.30:7410\n"
      "  yuragi status --quiet || mail -s \"the wall\" me@example.org < /dev/null\n"
      "--json: verdict (\"well\", \"attention\" or \"no daemon\"), attention (a list of texts), address, software,\n"
      "tick_rate_hz, running_s (null if unknown), scenes (name, kind, is_shown), players (as `yuragi player status\n"
      "--json`), and all that `yuragi sensors watch --json` has.");
  auto options = std::make_shared<StatusOptions>();
  add_daemon_address(*command, options->address);
  command->add_option("--config,-c", options->config_file, "the configuration with its address (TOML)")
      ->type_name("FILE");
  add_json(*command, options->as_json);
  command->add_flag("--quiet,-q", options->is_quiet, "print nothing but errors: only the exit code counts");
  command->callback([options] { show_daemon_status(*options); });
}

}  // namespace

extern const Command kStatusCommand;
const Command kStatusCommand{add_status};

}  // namespace yuragi::daemon::commands
