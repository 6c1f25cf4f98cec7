#include "drivers/windlog/time_of_day.hpp"

#include <algorithm>
#include <charconv>
#include <string>

#include <time.h>

namespace yuragi::drivers::windlog {
namespace {

constexpr Nanoseconds kDay = std::chrono::hours(24);
constexpr double kMaxOffset_h = 14.0;

/// `duration` in [0, a day).
Nanoseconds within_a_day(Nanoseconds duration) {
  const Nanoseconds rest = duration % kDay;
  return rest < Nanoseconds{0} ? rest + kDay : rest;
}

}  // namespace

Nanoseconds machine_utc_offset(UtcTime moment) {
  const std::time_t since_1970_s = std::chrono::floor<std::chrono::seconds>(moment).time_since_epoch().count();
  std::tm local{};
  if (localtime_r(&since_1970_s, &local) == nullptr) return Nanoseconds{0};
  return std::chrono::seconds(local.tm_gmtoff);
}

Result<UtcOffset, Failure> parse_utc_offset(std::string_view text) {
  if (text.empty()) return UtcOffset(machine_utc_offset);
  double offset_h = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), offset_h);
  if (error != std::errc{} || end != text.data() + text.size() ||
      !(offset_h >= -kMaxOffset_h && offset_h <= kMaxOffset_h)) {
    return Failure{
        "\"" + std::string(text) +
        "\" is not an offset from UTC; give hours from -14 to 14 (1, -3.5), or leave it empty for this machine's zone"};
  }
  return UtcOffset([offset = from_seconds(3600.0 * offset_h)](UtcTime) { return offset; });
}

Nanoseconds time_of_day(UtcTime moment, const UtcOffset& offset) {
  return within_a_day(moment.time_since_epoch() % kDay + offset(moment));
}

std::optional<Nanoseconds> find_time_of_day(std::span<const LoggedSession> sessions, Nanoseconds from,
                                            Nanoseconds wanted, const UtcOffset& recorded) {
  std::optional<Nanoseconds> next;
  Nanoseconds shortest_wait = kDay;
  for (const LoggedSession& session : sessions) {
    const Nanoseconds begin = std::max(from, session.log_begin);
    if (begin > session.log_end()) continue;
    const Nanoseconds wait =
        within_a_day(wanted - time_of_day(session.last.utc - (session.log_end() - begin), recorded));
    if (wait <= session.log_end() - begin) return begin + wait;

    // It never comes here. How much later than `wanted` does this session begin?
    const Nanoseconds later = within_a_day(-wait);
    if (!next || later < shortest_wait) {
      next = begin;
      shortest_wait = later;
    }
  }
  return next;
}

}  // namespace yuragi::drivers::windlog
