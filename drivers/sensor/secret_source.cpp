#include "drivers/sensor/secret_source.hpp"

#include <cstdlib>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>

#include "engine/platform/secret_file.hpp"

namespace yuragi::drivers::sensor {

Result<Secret, Failure> secret_in_environment(const std::string& variable) {
  const char* const value = std::getenv(variable.c_str());  // NOLINT(concurrency-mt-unsafe): nobody changes it
  if (value == nullptr) return Failure{"the environment variable \"" + variable + "\" is not set"};
  if (*value == '\0') return Failure{"the environment variable \"" + variable + "\" is empty"};
  return Secret(value);
}

Secret secret_of(const ParameterValues& values, const std::string& name) {
  const Secret& secret = values.secret(name);
  const std::string& file = values.text(name + "_file");
  const std::string& variable = values.text(name + "_env");
  if (static_cast<int>(!secret.is_empty()) + static_cast<int>(!file.empty()) + static_cast<int>(!variable.empty()) > 1)
    throw std::runtime_error(fmt::format("{0}: is set more than once; allowed: one of {0}, {0}_file, {0}_env", name));
  const auto found = [&name](std::string_view place, const Result<Secret, Failure>& result) {
    if (!result) throw std::runtime_error(fmt::format("{}_{}: {}", name, place, result.error().message));
    return *result;
  };
  if (!file.empty()) return found("file", platform::secret_in_file(file));
  if (!variable.empty()) return found("env", secret_in_environment(variable));
  return secret;
}

}  // namespace yuragi::drivers::sensor
