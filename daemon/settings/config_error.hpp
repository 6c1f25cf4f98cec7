#pragma once

#include <stdexcept>

namespace yuragi::daemon::settings {

/// The errors in a configuration, one line for each: `file:line:column: key: what is wrong; what is
/// allowed`.
class ConfigError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace yuragi::daemon::settings
