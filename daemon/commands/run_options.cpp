#include "daemon/commands/run_options.hpp"

#include <fmt/core.h>

#include "daemon/settings/page_file.hpp"
#include "engine/base/duration.hpp"

namespace yuragi::daemon::commands {

void RunOptions::add_to(CLI::App& command) {
  command.add_option("--listen", address, "where the daemon listens, instead of the configured address")
      ->type_name("HOST:PORT");
  add_common(command);
}

void RunOptions::add_to_client(CLI::App& command) {
  add_connect(command, address);
  add_common(command);
}

void RunOptions::add_common(CLI::App& command) {
  command.add_option("--config,-c", config_file, "the configuration (TOML); default: synthetic wind, one meadow")
      ->type_name("FILE");
  command.add_option("--duration", duration_s, "end after this time: 90 (seconds), 5min, 2h; without it: on Ctrl-C")
      ->type_name("TIME")
      ->transform(duration_in_seconds())
      ->check(CLI::PositiveNumber);
  command.add_flag("--verbose,-v", verbose, "log every attempt to connect to a sensor, not only changes");
}

void add_connect(CLI::App& command, std::optional<std::string>& address) {
  auto* const connect =
      command.add_option("--connect", address, "where the daemon listens, instead of the configured address")
          ->type_name("HOST:PORT");
  command
      .add_option_function<std::string>("--listen",
                                        [&address](const std::string& text) {
                                          fmt::print(stderr, "note: --listen is deprecated here: use --connect\n");
                                          address = text;
                                        })
      ->excludes(connect)
      ->group("");  // not shown in the help
}

CLI::Validator duration_in_seconds() {
  return CLI::Validator(duration_to_seconds, "");
}

settings::Config configuration_of(const std::optional<std::filesystem::path>& file) {
  if (!file) return settings::default_config();
  settings::Config config = settings::load_installation(*file);
  for (const std::string& warning : settings::page_warnings(config)) fmt::print(stderr, "warning: {}\n", warning);
  return config;
}

settings::Config RunOptions::config() const {
  settings::Config config = config_without_page();
  return config_file ? settings::with_page_file(std::move(config), *config_file) : config;
}

settings::Config RunOptions::config_without_page() const {
  settings::Config config = config_file ? settings::load_config(*config_file) : settings::default_config();
  return address ? settings::listening_at(std::move(config), *address) : config;
}

}  // namespace yuragi::daemon::commands
