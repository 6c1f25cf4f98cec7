#include "drivers/sensor/secret_source.hpp"

#include <cstdlib>
#include <fstream>
#include <stdexcept>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "engine/base/secret_line.hpp"

namespace yuragi::drivers::sensor {

Result<Secret, Failure> secret_in_file(const std::filesystem::path& file) {
  const auto fail = [&file](const std::string& why) { return Failure{"\"" + file.string() + "\" " + why}; };
  std::error_code error;
  const auto status = std::filesystem::status(file, error);
  if (status.type() == std::filesystem::file_type::not_found) return fail("does not exist");
  if (error) return fail("cannot be read: " + error.message());
  if (!std::filesystem::is_regular_file(status)) return fail("is not a regular file");  // a pipe would be waited for

  std::ifstream input(file, std::ios::binary);
  if (!input) return fail("cannot be read; allow it to the user that this program runs as");
  std::string text(kLongestSecretFile + 1, '\0');
  input.read(text.data(), static_cast<std::streamsize>(text.size()));
  if (input.bad()) return fail("cannot be read");
  text.resize(static_cast<std::size_t>(input.gcount()));
  if (text.size() > kLongestSecretFile) {
    return fail("is too long; allowed: " + std::to_string(kLongestSecretFile) + " bytes");
  }

  auto secret = secret_line(std::move(text));
  return secret ? std::move(secret) : fail(secret.error().message);
}

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
    throw std::runtime_error(fmt::format("{0}: is given more than once; allowed: one of {0}, {0}_file, {0}_env", name));
  const auto found = [&name](std::string_view place, const Result<Secret, Failure>& result) {
    if (!result) throw std::runtime_error(fmt::format("{}_{}: {}", name, place, result.error().message));
    return *result;
  };
  if (!file.empty()) return found("file", secret_in_file(file));
  if (!variable.empty()) return found("env", secret_in_environment(variable));
  return secret;
}

}  // namespace yuragi::drivers::sensor
