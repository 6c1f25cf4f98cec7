#include "daemon/settings/local_clock.hpp"

#include <stdexcept>

#include <date/tz.h>
#include <fmt/format.h>

namespace yuragi::daemon::settings {
namespace {

/// The library's object of the zone. Null: UTC.
const date::time_zone* find_zone(const std::string& name) {
  if (!name.empty()) return date::locate_zone(name);
  try {
    return date::current_zone();
  } catch (const std::exception&) {
    return nullptr;  // without /etc/localtime the machine runs on UTC
  }
}

}  // namespace

Result<LocalClock, ParameterError> LocalClock::of_zone(const std::string& name) {
  LocalClock clock;
  try {
    clock.zone_ = find_zone(name);
  } catch (const std::exception&) {
    return ParameterError{"zone", fmt::format("is \"{}\", a time zone that this machine does not know; allowed: a "
                                              "name such as \"Europe/Berlin\" or \"Asia/Tokyo\" (timedatectl "
                                              "list-timezones), or \"\" for this machine's own",
                                              name)};
  }
  return clock;
}

std::chrono::seconds LocalClock::since_1970(UtcTime now) const {
  const auto utc = std::chrono::floor<std::chrono::seconds>(now);
  return zone_ != nullptr ? zone_->to_local(utc).time_since_epoch() : utc.time_since_epoch();
}

double LocalClock::hour_of_day(UtcTime now) const {
  const std::chrono::seconds local = since_1970(now);
  const std::chrono::seconds of_day = local - std::chrono::floor<std::chrono::days>(local);
  return static_cast<double>(of_day.count()) / 3600.0;
}

std::string LocalClock::zone_name() const {
  return zone_ != nullptr ? zone_->name() : "UTC";
}

}  // namespace yuragi::daemon::settings
