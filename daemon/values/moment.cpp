#include "daemon/values/moment.hpp"

#include <algorithm>
#include <chrono>

#include <fmt/chrono.h>
#include <fmt/format.h>

namespace yuragi::daemon::values {

std::optional<std::size_t> index_of(std::span<const std::string> names, std::string_view name) noexcept {
  const auto found = std::ranges::find(names, name);
  if (found == names.end()) return std::nullopt;
  return static_cast<std::size_t>(found - names.begin());
}

std::string utc_text(UtcTime utc) {
  const auto milliseconds = std::chrono::floor<std::chrono::milliseconds>(utc);
  const auto whole = std::chrono::floor<std::chrono::seconds>(milliseconds);
  return fmt::format("{:%Y-%m-%dT%H:%M:%S}.{:03}Z", fmt::gmtime(std::chrono::system_clock::to_time_t(whole)),
                     (milliseconds - whole).count());
}

std::string_view name_of(wind::Source source) noexcept {
  switch (source) {
    case wind::Source::kLive:
      return "live";
    case wind::Source::kHandover:
      return "handover";
    case wind::Source::kDefault:
      break;
  }
  return "default";
}

}  // namespace yuragi::daemon::values
