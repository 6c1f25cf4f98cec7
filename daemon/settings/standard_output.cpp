#include "daemon/settings/standard_output.hpp"

#include <cerrno>
#include <cstdio>
#include <system_error>

#include <fmt/format.h>

#include "engine/base/result.hpp"

namespace yuragi::daemon::settings {

void write_at_once(std::string_view text) {
  const bool is_written = std::fwrite(text.data(), 1, text.size(), stdout) == text.size() && std::fflush(stdout) == 0;
  if (is_written) return;
  throw FailureError({fmt::format("cannot write to standard output: {}", std::generic_category().message(errno)),
                      FailureKind::kCannotCreate});
}

}  // namespace yuragi::daemon::settings
