#include "daemon/settings/own_token.hpp"

#include <cstdlib>
#include <exception>

#include <fmt/format.h>
#include <grp.h>
#include <sys/stat.h>
#include <unistd.h>

#include "daemon/settings/config.hpp"
#include "engine/base/address.hpp"
#include "engine/platform/secret_file.hpp"

namespace yuragi::daemon::settings {
namespace {

constexpr const char* kVariable = "YURAGI_TOKEN_FILE";

bool is_of_this_machine(const std::string& address) {
  const auto parsed = parse_address(address);
  return parsed && (parsed->host == "localhost" || parsed->host == "::1" || parsed->host.starts_with("127."));
}

/// [http] token_file of a configuration; empty if it has none or cannot be read: then the command continues without it.
std::string token_file_of(const std::filesystem::path& config) {
  if (access(config.c_str(), R_OK) != 0) return {};
  try {
    return load_config(config).http.token_file;
  } catch (const std::exception&) {
    return {};
  }
}

std::string group_hint(const std::string& file) {
  struct stat status {};
  if (::stat(file.c_str(), &status) != 0) return {};
  const group* const members = getgrgid(status.st_gid);  // NOLINT(concurrency-mt-unsafe): a command has one thread
  if (members == nullptr || (status.st_mode & S_IRGRP) == 0) return {};
  return fmt::format("you may not read {}; its group \"{}\" may (`sudo adduser YOUR-NAME {}`, then log in again)", file,
                     members->gr_name, members->gr_name);
}

}  // namespace

OwnToken own_token(const std::string& address, const std::filesystem::path& config) {
  const char* const file = std::getenv(kVariable);  // NOLINT(concurrency-mt-unsafe): nobody changes it
  if (file != nullptr && *file != '\0') {
    auto token = platform::secret_in_file(file);
    if (!token) throw FailureError({std::string(kVariable) + ": " + token.error().message, FailureKind::kNoInput});
    return {.token = std::move(*token), .hint = {}};
  }
  if (!is_of_this_machine(address)) return {};
  const std::string configured = token_file_of(config);
  if (configured.empty()) return {};
  if (access(configured.c_str(), R_OK) != 0) return {.token = {}, .hint = group_hint(configured)};
  auto token = platform::secret_in_file(configured);
  return token ? OwnToken{.token = std::move(*token), .hint = {}} : OwnToken{};
}

}  // namespace yuragi::daemon::settings
