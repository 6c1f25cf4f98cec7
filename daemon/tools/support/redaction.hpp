#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "daemon/settings/config.hpp"

namespace yuragi::daemon::tools::support {

/// The secrets of a configuration: those that stand in it, those in the files and in the environment variables that it
/// names. What cannot be read is passed over. For Redaction and for nothing else.
std::vector<std::string> known_secrets(const settings::Config& config);

/// Takes secrets out of a text for strangers to read: each of those that are known, in any place, and what looks
/// like one: the value behind a word such as password, passphrase, token or psk and a = or :, and the user and password
/// in a URL. Secret::kWithheld replaces them. The name of a file or variable with a secret in it
/// (password_file, password_env) stays. Thread-safe: its const functions are.
class Redaction {
 public:
  explicit Redaction(const std::vector<std::string>& secrets);

  std::string apply(std::string text) const;

 private:
  std::vector<std::string> secrets_;  ///< as they are and as TOML and JSON write them, the longest first
};

}  // namespace yuragi::daemon::tools::support
