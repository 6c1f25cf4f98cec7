#pragma once

#include <string>

#include "engine/base/secret.hpp"
#include "engine/base/time.hpp"

namespace yuragi::daemon::alerts {

/// The beginning or end of an alert, and where to report it.
struct News {
  std::string alert = {};    ///< its name
  bool has_begun = false;    ///< false: it has ended
  std::string message = {};  ///< a sentence
  UtcTime time{};
  std::string command = {};  ///< empty: none
  Secret webhook = {};       ///< empty: none
};

}  // namespace yuragi::daemon::alerts
