#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "engine/base/result.hpp"

namespace yuragi::daemon::settings {

/// A text of TOML with Secret::kWithheld in place of each secret.
struct WithheldText {
  std::string text;
  std::size_t secrets = 0;  ///< that were in it; 0: it is the text that was given
};

// For recordings that were made while passwords were still recorded. Which values are secrets is taken from the tables
// of the drivers; a driver that is not known has the secrets of all others. Everything but these values stays as it is,
// byte by byte, if the layout allows it, else all values do. An empty secret is none. A text that is not TOML is a
// failure, whose message shows nothing of it. Pure.

/// Of a whole configuration.
Result<WithheldText, Failure> withhold_in_configuration(std::string_view toml_text);

/// Of the options of one sensor, a table with the keys of its driver.
Result<WithheldText, Failure> withhold_in_options(std::string_view toml_text, std::string_view driver);

}  // namespace yuragi::daemon::settings
