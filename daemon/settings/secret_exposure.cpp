#include "daemon/settings/secret_exposure.hpp"

#include <system_error>

#include <fmt/format.h>

namespace yuragi::daemon::settings {
namespace {

bool is_read_by_everybody(const std::filesystem::path& file) {
  std::error_code error;
  const std::filesystem::file_status status = std::filesystem::status(file, error);
  return !error && (status.permissions() & std::filesystem::perms::others_read) != std::filesystem::perms::none;
}

}  // namespace

std::vector<std::string> exposed_secrets(const Config& config, const std::filesystem::path& file) {
  std::vector<std::string> warnings;
  const auto warn = [&](const SensorConfig& sensor, const Parameter& parameter, const std::string& exposed) {
    warnings.push_back(fmt::format("{}: sensor.{}: everybody on this machine can read {}; chmod 640 {}", sensor.origin,
                                   parameter.name, exposed, exposed));
  };
  for (const SensorConfig& sensor : config.sensors) {
    for (const Parameter& parameter : sensor.driver->parameters) {
      if (!sensor.values.has(parameter.name)) continue;
      const ParameterValue& value = sensor.values.all().find(parameter.name)->second;
      const auto* secret = std::get_if<Secret>(&value);
      const auto* text = std::get_if<std::string>(&value);
      if (secret != nullptr && !secret->is_empty() && is_read_by_everybody(file)) {
        warn(sensor, parameter, file.string());
      } else if (text != nullptr && parameter.is_secret_file && !text->empty() && is_read_by_everybody(*text)) {
        warn(sensor, parameter, *text);
      }
    }
  }
  for (const AlertConfig& alert : config.alerts) {
    if (!alert.webhook.is_empty() && is_read_by_everybody(file)) {
      warnings.push_back(fmt::format("alert {}: webhook: everybody on this machine can read {}; chmod 640 {}",
                                     alert.name, file.string(), file.string()));
    }
  }
  if (const std::string& token = config.http.token_file; !token.empty() && is_read_by_everybody(token)) {
    warnings.push_back(
        fmt::format("http.token_file: everybody on this machine can read {}; chmod 640 {}", token, token));
  }
  return warnings;
}

}  // namespace yuragi::daemon::settings
