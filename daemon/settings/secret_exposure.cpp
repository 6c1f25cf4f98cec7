#include "daemon/settings/secret_exposure.hpp"

#include <system_error>
#include <vector>

#include <fmt/format.h>

#include "daemon/settings/each_value.hpp"

namespace yuragi::daemon::settings {

bool is_read_by_everybody(const std::filesystem::path& file) {
  std::error_code error;
  const std::filesystem::file_status status = std::filesystem::status(file, error);
  return !error && (status.permissions() & std::filesystem::perms::others_read) != std::filesystem::perms::none;
}

std::vector<std::string> exposed_secrets(const Config& config, const std::filesystem::path& file) {
  std::vector<std::string> warnings;
  Config written = config;  // what is in this file: that of the page is its owner's alone
  if (!config.page_file.empty()) {
    std::erase_if(written.sensors,
                  [&](const SensorConfig& sensor) { return sensor.origin.starts_with(config.page_file + ":"); });
  }
  for_each_value(written, [&](const std::string& where, const Parameter& parameter, const ParameterValue& value) {
    const auto* secret = std::get_if<Secret>(&value);
    const auto* text = std::get_if<std::string>(&value);
    std::filesystem::path exposed;
    // A command may hold a secret, and mostly holds none.
    if (secret != nullptr && !secret->is_empty() && !parameter.takes_control_characters) exposed = file;
    if (text != nullptr && parameter.is_secret_file) exposed = *text;
    if (exposed.empty() || !is_read_by_everybody(exposed)) return;
    warnings.push_back(fmt::format("{}{}: everybody on this machine can read {}; chmod 640 {}", where, parameter.name,
                                   exposed.string(), exposed.string()));
  });
  return warnings;
}

}  // namespace yuragi::daemon::settings
