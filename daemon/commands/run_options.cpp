#include "daemon/commands/run_options.hpp"

#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

namespace yuragi {

void RunOptions::add_to(CLI::App& command) {
  command.add_option("--config,-c", config_file, "the installation, as TOML; without it: synthetic wind, one meadow")
      ->type_name("FILE");
  command.add_option("--listen", listen, "where the daemon listens, instead of the configured address")
      ->type_name("HOST:PORT");
  command.add_option("--duration", duration_s, "end after this many seconds; without it: run until Ctrl-C")
      ->type_name("SECONDS")
      ->check(CLI::PositiveNumber);
  command.add_flag("--verbose,-v", verbose, "log every attempt to reach a sensor, not only changes");
}

Config RunOptions::config() const {
  Config config = config_file ? load_config(*config_file) : default_config();
  return listen ? listening_at(std::move(config), *listen) : config;
}

void RunOptions::set_up_log() const {
  static const auto logger = spdlog::stderr_color_mt("yuragi");
  spdlog::set_default_logger(logger);
  spdlog::set_pattern("%Y-%m-%dT%H:%M:%S.%e %^%l%$ %v");
  spdlog::set_level(verbose ? spdlog::level::debug : spdlog::level::info);
}

}  // namespace yuragi
