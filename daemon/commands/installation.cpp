#include "daemon/commands/installation.hpp"

#include <fmt/core.h>
#include <unistd.h>

#include "daemon/commands/ask_daemon.hpp"
#include "daemon/service/config_check.hpp"
#include "daemon/settings/own_token.hpp"
#include "daemon/settings/page_file.hpp"

namespace yuragi::daemon::commands {

void add_installation_config(CLI::App& command, std::optional<std::filesystem::path>& file) {
  command
      .add_option("--config,-c", file,
                  fmt::format("the configuration (TOML); default: {}, else the built-in one", settings::kServiceConfig))
      ->type_name("FILE");
}

void add_daemon_address(CLI::App& command, std::optional<std::string>& address) {
  command.add_option("--connect", address, "where the daemon listens, instead of the configured address")
      ->type_name("HOST:PORT");
}

std::optional<std::filesystem::path> installed_config(const std::optional<std::filesystem::path>& given) {
  if (given) return given;
  if (access(settings::kServiceConfig, R_OK) == 0) return settings::kServiceConfig;
  return std::nullopt;
}

tools::doctor::Examination examination_of(const std::optional<std::filesystem::path>& given,
                                          const std::optional<std::string>& address, const std::string& client) {
  tools::doctor::Examination examination;
  examination.config_file = installed_config(given);
  try {
    settings::Config config =
        examination.config_file ? settings::load_installation(*examination.config_file) : settings::default_config();
    service::check(config);
    if (address) config = settings::listening_at(std::move(config), *address);
    examination.config = std::move(config);
  } catch (const std::exception& error) {  // ConfigError, and errors of a sensor or a recording
    examination.config_error = error.what();
  }
  const std::string asked = address              ? *address
                            : examination.config ? examination.config->stream.listen
                                                 : settings::default_config().stream.listen;
  if (auto status = ask_daemon(asked, client)) examination.daemon = std::move(*status);
  return examination;
}

}  // namespace yuragi::daemon::commands
