// `yuragi doctor`: what is wrong with an installation, and the commands that fix it.
#include <memory>
#include <optional>
#include <string_view>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "daemon/commands/command.hpp"
#include "daemon/commands/exit.hpp"
#include "daemon/commands/installation.hpp"
#include "daemon/commands/json_output.hpp"
#include "daemon/commands/slow_notice.hpp"
#include "daemon/settings/standard_output.hpp"

namespace yuragi::daemon::commands {
namespace {

struct DoctorOptions {
  std::optional<std::filesystem::path> config_file;
  std::optional<std::string> address;
  bool as_json = false;
};

void run_doctor(const DoctorOptions& options) {
  std::optional<SlowNotice> notice;
  const auto announce = [&notice](std::string_view step) { notice.emplace(fmt::format("examining {} ...", step)); };
  announce("the daemon that runs");
  const tools::doctor::Examination examination = examination_of(options.config_file, options.address, "doctor");
  const auto findings = tools::doctor::examine(examination, announce);
  notice.reset();
  if (options.as_json) {
    print_json(tools::doctor::findings_json(findings));
  } else {
    settings::write_at_once(tools::doctor::findings_text(findings));
  }
  if (tools::doctor::gravest(findings) == tools::doctor::Verdict::kError) throw ExitError(kExitAttention, "");
}

void add_doctor(CLI::App& app) {
  CLI::App* command =
      app.add_subcommand("doctor", "find what is wrong with an installation, and the commands that fix it");
  command->footer(
      "Looks at the configuration, the devices that it names (serial ports, USB devices, sound cards, hosts, brokers,\n"
      "files), permissions, clock, disk, listening address, graphics and display, versions and limits. It changes\n"
      "nothing, and leaves alone what a running daemon has readings from. A host that does not reply takes 2 s.\n"
      "Ask as the user that the daemon runs as: sudo -u yuragi yuragi doctor\n"
      "If yuragi.service is installed, it also tries the next boot, as `yuragi check-config --as-service` does.\n"
      "Exit code 0: no error, warnings at most; 1: errors; 64: the command line.\n"
      "--json: verdict (\"ok\", \"warning\" or \"error\": the gravest) and findings, a list with area, verdict, text "
      "and\n"
      "remedy (null if nothing is wrong).");
  auto options = std::make_shared<DoctorOptions>();
  add_installation_config(*command, options->config_file);
  add_daemon_address(*command, options->address);
  add_json(*command, options->as_json);
  command->callback([options] { run_doctor(*options); });
}

}  // namespace

extern const Command kDoctorCommand;
const Command kDoctorCommand{add_doctor};

}  // namespace yuragi::daemon::commands
