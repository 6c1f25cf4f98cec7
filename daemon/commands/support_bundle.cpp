// `yuragi support-bundle`: packs the information that a helper needs, without secrets.
#include "daemon/tools/support/support_bundle.hpp"

#include <chrono>
#include <memory>

#include <date/date.h>
#include <fmt/core.h>

#include "daemon/commands/command.hpp"
#include "daemon/commands/exit.hpp"
#include "daemon/commands/installation.hpp"
#include "daemon/commands/lock_recording.hpp"
#include "engine/base/count_text.hpp"
#include "engine/platform/whole_file.hpp"

namespace yuragi::daemon::commands {
namespace {

struct BundleOptions {
  std::optional<std::filesystem::path> config_file;
  std::optional<std::string> address;
  std::string output;
  bool with_host_name = false;
  bool with_readings = false;
  bool force = false;
};

void make_bundle(const BundleOptions& options) {
  tools::support::BundleRequest request;
  request.now = std::chrono::system_clock::now();
  const std::string folder =
      "yuragi-support-" + date::format("%Y%m%dT%H%M%SZ", std::chrono::floor<std::chrono::seconds>(request.now));
  const std::string name = options.output.empty() ? folder + ".tar.gz" : options.output;
  const auto lock = lock_output(name);
  platform::OutputFile output(name, options.force);  // checked before the work
  request.examination = examination_of(options.config_file, options.address, "support-bundle");
  request.findings = tools::doctor::examine(request.examination);
  request.with_host_name = options.with_host_name;
  request.with_readings = options.with_readings;
  const auto files = tools::support::bundle_files(request);
  tools::support::pack(files, folder, output.working_path()).value();
  output.commit().value();
  fmt::print("{}: {}; look through it before you send it: tar -xzOf {} | less\n", name,
             count_text(files.size(), "file"), name);
}

void add_support_bundle(CLI::App& app) {
  CLI::App* command =
      app.add_subcommand("support-bundle", "pack what a helper needs to know of an installation, without secrets");
  command->footer(
      "Packs the configuration, the output of `yuragi doctor` and `yuragi status`, the last 5000 lines of the log of "
      "each\n"
      "unit, the sessions and counts of the recording, and what the system reports of its kernel, packages, disks and\n"
      "devices. \"(secret)\" stands in place of each password of the configuration wherever it occurs, and of what "
      "looks\n"
      "like one (behind password, passphrase, token, psk, ..., and in URLs). The name of this machine is left out.\n"
      "A configuration that is not TOML is left out. The file is readable by its owner and group (0640).\n"
      "To include the log, run it as a user who may read it: sudo yuragi support-bundle\n"
      "Exit code 0: written; 73: it cannot be written.");
  auto options = std::make_shared<BundleOptions>();
  add_installation_config(*command, options->config_file);
  add_daemon_address(*command, options->address);
  command->add_option("--out,-o", options->output, "the file to write; default: yuragi-support-TIME.tar.gz here")
      ->type_name("FILE.tar.gz");
  command->add_flag("--readings", options->with_readings, "add the readings of the recording's last hour (CSV)");
  command->add_flag("--host-name", options->with_host_name, "add the name of this machine");
  command->add_flag("--force", options->force, "overwrite the file");
  command->callback([options] { make_bundle(*options); });
}

}  // namespace

extern const Command kSupportBundleCommand;
const Command kSupportBundleCommand{add_support_bundle};

}  // namespace yuragi::daemon::commands
