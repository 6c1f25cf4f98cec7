#include "daemon/tools/csv/csv_zone.hpp"

#include <exception>

#include <date/tz.h>

#include "daemon/tools/csv/csv_time.hpp"
#include "daemon/tools/csv/csv_words.hpp"

namespace yuragi::daemon::tools::csv {

Result<Zone, Failure> Zone::parse(std::string_view text) {
  Zone zone;
  zone.name_ = without_blanks(text);
  // As it would follow a time.
  const auto written = parse_time("2000-01-01 00:00 " + zone.name_, TimeFormat::kIso);
  if (written && written->utc_offset) {
    zone.offset_ = *written->utc_offset;
    return zone;
  }
  try {
    zone.zone_ = date::locate_zone(zone.name_);
    return zone;
  } catch (const std::exception&) {
    return Failure{
        "\"" + zone.name_ +
            "\" is not a time zone; allowed: UTC, an offset such as +02:00, or a place such as Europe/Berlin "
            "(timedatectl list-timezones)",
        FailureKind::kUsage};
  }
}

std::optional<UtcTime> Zone::to_utc(UtcTime clock, std::optional<UtcTime> last) const {
  if (zone_ == nullptr) return clock - offset_;
  const date::local_info info =
      zone_->get_info(date::local_seconds(std::chrono::floor<std::chrono::seconds>(clock).time_since_epoch()));
  if (info.result == date::local_info::nonexistent) return std::nullopt;
  const UtcTime first = clock - info.first.offset;
  const bool comes_twice = info.result == date::local_info::ambiguous;
  return comes_twice && last && first <= *last ? clock - info.second.offset : first;
}

}  // namespace yuragi::daemon::tools::csv
