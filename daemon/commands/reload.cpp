// `yuragi reload`: has a running daemon read its configuration again.
#include <array>
#include <filesystem>
#include <memory>
#include <optional>
#include <string_view>

#include <fmt/core.h>

#include "daemon/commands/command.hpp"
#include "daemon/commands/exit.hpp"
#include "daemon/commands/json_output.hpp"
#include "daemon/commands/run_options.hpp"
#include "daemon/settings/config.hpp"
#include "daemon/settings/config_file.hpp"
#include "daemon/settings/own_token.hpp"
#include "daemon/stream/control_client.hpp"

namespace yuragi::daemon::commands {
namespace {

constexpr const char* kReloadFooter =
    "The daemon reads the file that it was started with, and applies what can change while it runs: scenes,\n"
    "[sensor.calibration] except for heights, [sensor.judge], [shaping], [look], [[camera]], [log], permissions and\n"
    "limits of clients, limits of the recording, and the rate of recordings that play. Other changes are listed:\n"
    "they need a restart. A mistake changes nothing. SIGHUP does the same, and logs the result.\n"
    "  yuragi reload                            the daemon at 127.0.0.1:7410\n"
    "  yuragi reload --config wall.toml         the one that was started with this file, at its address\n"
    "Exit code 0: done; 64: the daemon has another file or none; 69: no daemon replies; 70: it failed, and the\n"
    "reason is printed; 77: the daemon does not allow it from here (see `yuragi describe`, [stream] control); 78:\n"
    "the file has a mistake.\n"
    "--json: outcome (\"done\", \"mistake\", \"not allowed\", \"no file\" or \"failed\"), and lists of texts:\n"
    "applied, takes_restart, mistakes; with the outcome \"done\" these are warnings about the next start.";

struct ReloadOptions {
  std::optional<std::string> connect;
  std::optional<std::filesystem::path> config_file;
  bool as_json = false;
};

constexpr std::array<std::string_view, 5> kOutcomeNames = {"done", "mistake", "not allowed", "no file", "failed"};

int exit_code_of(wire::ReloadOutcome outcome) {
  switch (outcome) {
    case wire::ReloadOutcome::kDone:
      return 0;
    case wire::ReloadOutcome::kMistake:
      return kExitConfig;
    case wire::ReloadOutcome::kNotAllowed:
      return kExitNoPermission;
    case wire::ReloadOutcome::kNoFile:
      return kExitUsage;
    case wire::ReloadOutcome::kFailed:
      break;
  }
  return kExitSoftware;
}

void reload(const ReloadOptions& options) {
  std::string address = fmt::format("127.0.0.1:{}", wire::kDefaultPort);
  std::string file;
  if (options.config_file) {
    address = settings::load_config(*options.config_file).stream.listen;
    file = settings::absolute_path(*options.config_file);
  }
  address = options.connect.value_or(address);
  const settings::OwnToken own =
      options.config_file ? settings::own_token(address, *options.config_file) : settings::own_token(address);
  wire::ReloadReport report = stream::ask_to_reload(address, file, own.token).value();
  if (report.outcome == wire::ReloadOutcome::kNotAllowed && !own.hint.empty()) report.mistakes.push_back(own.hint);
  if (options.as_json) {
    print_json({{"outcome", kOutcomeNames.at(static_cast<std::size_t>(report.outcome))},
                {"applied", report.applied},
                {"takes_restart", report.takes_restart},
                {"mistakes", report.mistakes}});
    if (report.outcome != wire::ReloadOutcome::kDone) throw ExitError(exit_code_of(report.outcome), "");
    return;
  }
  const std::string text = stream::reload_text(report);
  if (report.outcome == wire::ReloadOutcome::kDone) {
    fmt::print("{}", text);
    return;
  }
  if (report.outcome == wire::ReloadOutcome::kMistake) throw settings::ConfigError(text + "nothing was changed");
  throw ExitError(exit_code_of(report.outcome), text + "nothing was changed");
}

void add_reload(CLI::App& app) {
  CLI::App* command = app.add_subcommand("reload", "have a running daemon read its configuration again");
  command->footer(kReloadFooter);
  auto options = std::make_shared<ReloadOptions>();
  command->add_option("--connect", options->connect, "where the daemon listens")->type_name("HOST:PORT");
  command->add_option("--config,-c", options->config_file, "the file that the daemon was started with")
      ->type_name("FILE");
  add_json(*command, options->as_json);
  command->callback([options] { reload(*options); });
}

}  // namespace

extern const Command kReloadCommand;
const Command kReloadCommand{add_reload};

}  // namespace yuragi::daemon::commands
