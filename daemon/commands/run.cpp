// `yuragi run` and `yuragi record`: the daemon, with and without scenes.
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <iterator>
#include <memory>
#include <optional>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include <linux/close_range.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include "daemon/commands/command.hpp"
#include "daemon/commands/run_options.hpp"
#include "daemon/service/daemon_log.hpp"
#include "daemon/service/hold_back_hangups.hpp"
#include "daemon/service/service.hpp"
#include "daemon/settings/config_file.hpp"
#include "daemon/settings/page_file.hpp"
#include "daemon/settings/secret_exposure.hpp"
#include "daemon/tools/doctor/rehearsal.hpp"

namespace yuragi::daemon::commands {
namespace {

/// The configuration of the daemon; warns of secrets in it that others can read.
settings::Config config_with_warnings(const RunOptions& options) {
  settings::Config config = options.config();
  if (options.config_file) {
    for (const std::string& warning : settings::exposed_secrets(config, *options.config_file)) {
      spdlog::warn("{}", warning);
    }
  }
  return config;
}

/// Puts this program with its arguments in the place of this process: of a service it stays the main process, and no
/// service manager is needed. Throws std::system_error.
[[noreturn]] void start_again() {
  std::ifstream file("/proc/self/cmdline", std::ios::binary);
  std::string words((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
  std::vector<char*> arguments;
  for (std::size_t at = 0; at < words.size(); at += std::strlen(&words[at]) + 1) arguments.push_back(&words[at]);
  arguments.push_back(nullptr);
  close_range(STDERR_FILENO + 1, ~0U, CLOSE_RANGE_CLOEXEC);  // what a thread that hangs has left open
  std::fflush(nullptr);
  execv("/proc/self/exe", arguments.data());
  throw std::system_error(errno, std::generic_category(), "the daemon cannot be started again");
}

/// Runs the daemon, whose configuration can be read again if it is a file. `record`: the recording in place of the
/// configured one. A configuration that cannot be used together with what the page has set up is used without that.
/// Returns true if it is to be started again.
bool run_once(const RunOptions& options, const std::optional<std::filesystem::path>& record, bool with_scenes) {
  service::hold_back_hangups();
  const service::DaemonLog log(options.verbose);
  const settings::Config config = config_with_warnings(options);
  log.set_level(config.log.level);
  for (const std::string& warning : settings::page_warnings(config)) spdlog::warn("{}", warning);
  service::Options service{.record = record ? record : config.recording.file,
                           .duration_s = options.duration_s,
                           .with_scenes = with_scenes,
                           .set_log_level = [&log](settings::LogLevel level) { log.set_level(level); },
                           .can_be_restarted = true,
                           .log_tail = log.tail(),
                           .fault_counter = service::DaemonLog::fault_counter()};
  if (options.config_file) {
    service.config_file = *options.config_file;
    service.read_config = [options] { return config_with_warnings(options); };
    service.rehearse = [file = settings::absolute_path(*options.config_file)](const settings::Config& running,
                                                                              const settings::Config& next) {
      std::vector<std::string> warnings = settings::page_warnings(next);
      for (std::string& warning : tools::doctor::next_start_warnings(running, next, file))
        warnings.push_back(std::move(warning));
      return warnings;
    };
  }
  std::optional<service::Service> daemon;
  try {
    daemon.emplace(config, service);
  } catch (const settings::ConfigError& fault) {
    if (config.page_file.empty()) throw;
    spdlog::warn("what the page has set up is left out ({}): the daemon cannot be started with it: {}",
                 config.page_file, fault.what());
    settings::Config own = options.config_without_page();
    own.page_trouble = fault.what();
    daemon.emplace(own, service);
  }
  return daemon->run();
}

void run_daemon(const RunOptions& options, const std::optional<std::filesystem::path>& record, bool with_scenes) {
  if (run_once(options, record, with_scenes)) start_again();
}

void add_run(CLI::App& app) {
  CLI::App* command =
      app.add_subcommand("run", "run the daemon: read the wind, move the scenes, stream them to viewers");
  command->footer(
      "Without --config it uses a synthetic wind and shows a meadow. Then, in another terminal:\n"
      "  yuragi-viewer                show the scenes\n"
      "  yuragi sensors watch         show the sensors\n"
      "  yuragi describe              list every key of a configuration\n"
      "  yuragi reload                read the configuration again while it runs; so does SIGHUP");
  auto options = std::make_shared<RunOptions>();
  auto record = std::make_shared<std::optional<std::filesystem::path>>();
  options->add_to(*command);
  command->add_option("--record", *record, "also write every reading to this recording, instead of [recording] file")
      ->type_name("FILE.windlog");
  command->callback([options, record] { run_daemon(*options, *record, true); });
}

void add_record(CLI::App& app) {
  CLI::App* command = app.add_subcommand("record", "record the sensors, without scenes");
  command->footer(
      "A recording that exists is continued. Stop it with Ctrl-C; a crash loses at most a second.\n"
      "  yuragi record storm.windlog --config roof.toml\n"
      "  yuragi replay storm.windlog --rate 4");
  auto options = std::make_shared<RunOptions>();
  auto file = std::make_shared<std::filesystem::path>();
  command->add_option("file", *file, "the recording")->required()->type_name("FILE.windlog");
  options->add_to(*command);
  command->callback([options, file] { run_daemon(*options, *file, false); });
}

}  // namespace

extern const Command kRunCommand;
const Command kRunCommand{add_run};

extern const Command kRecordCommand;
const Command kRecordCommand{add_record};

}  // namespace yuragi::daemon::commands
