#include "daemon/settings/duration_text.hpp"

#include <cmath>
#include <cstdint>
#include <string_view>

#include <fmt/format.h>

namespace yuragi::daemon::settings {

std::string duration_text(double duration_s) {
  if (duration_s < 59.95) return fmt::format("{:.3g} s", duration_s);
  const auto whole_s = static_cast<std::int64_t>(std::llround(duration_s));
  const auto two = [](std::int64_t large, std::string_view large_name, std::int64_t small,
                      std::string_view small_name) {
    return small == 0 ? fmt::format("{} {}", large, large_name)
                      : fmt::format("{} {} {} {}", large, large_name, small, small_name);
  };
  if (whole_s < 3600) return two(whole_s / 60, "min", whole_s % 60, "s");
  if (whole_s < 86400) return two(whole_s / 3600, "h", whole_s % 3600 / 60, "min");
  return two(whole_s / 86400, whole_s / 86400 < 2 ? "day" : "days", whole_s % 86400 / 3600, "h");
}

}  // namespace yuragi::daemon::settings
