#pragma once

#include <cstdint>

namespace yuragi::daemon::web {

/// What clients did by HTTP since the daemon began.
struct Counts {
  std::uint64_t pairings = 0;         ///< browsers that were paired
  std::uint64_t failed_pairings = 0;  ///< wrong or used codes, and too many attempts
  std::uint64_t refused_tokens = 0;   ///< requests with a wrong token or session
  std::uint64_t changes = 0;          ///< requests that changed something
};

}  // namespace yuragi::daemon::web
