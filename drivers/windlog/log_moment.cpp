#include "drivers/windlog/log_moment.hpp"

#include <charconv>
#include <cmath>
#include <string>

#include "drivers/windlog/format.hpp"
#include "drivers/windlog/sqlite.hpp"
#include "drivers/windlog/windlog_reader.hpp"

namespace yuragi {
namespace {

constexpr std::string_view kHelp =
    R"(; give seconds from the beginning (90) or a moment (2018-07-20T14:05:00Z; UTC where it names no zone))";

/// A moment in ISO 8601 by SQLite's own date functions, to the millisecond.
Result<UtcTime, Failure> parse_moment(std::string_view text) {
  const Failure refusal{"\"" + std::string(text) + "\" is not a time" + std::string(kHelp), FailureKind::kUsage};
  // SQLite would take "now" and day numbers too; a date has its first dash here.
  if (text.size() < 10 || text[4] != '-') return refusal;
  auto calendar = sqlite::Database::open(":memory:", sqlite::Access::kCalculator);
  if (!calendar) return calendar.error();
  auto milliseconds = calendar->prepare("SELECT CAST(round((julianday(?1) - 2440587.5) * 86400000) AS INTEGER)");
  if (!milliseconds) return milliseconds.error();
  milliseconds->bind(1, text);
  if (milliseconds->step() != sqlite::Statement::Step::kRow || milliseconds->type(0) == SQLITE_NULL) return refusal;

  constexpr std::int64_t kNanosecondsPerMillisecond = 1'000'000;
  const std::int64_t since_1970_ms = milliseconds->integer(0);
  if (std::abs(since_1970_ms) > windlog::kMaxTime_ns / kNanosecondsPerMillisecond) return refusal;
  return UtcTime(Nanoseconds(since_1970_ms * kNanosecondsPerMillisecond));
}

}  // namespace

Result<LogMoment, Failure> parse_log_moment(std::string_view text) {
  if (text.empty()) return LogMoment(Nanoseconds{0});
  double from_s = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), from_s);
  if (error == std::errc{} && end == text.data() + text.size()) {
    if (!(from_s >= 0.0) || from_s > seconds(Nanoseconds(windlog::kMaxTime_ns))) {
      return Failure{"\"" + std::string(text) + "\" is not in a recording" + std::string(kHelp), FailureKind::kUsage};
    }
    return LogMoment(from_seconds(from_s));
  }
  const auto moment = parse_moment(text);
  if (!moment) return moment.error();
  return LogMoment(*moment);
}

Result<std::optional<Nanoseconds>, Failure> log_time_of(WindlogReader& reader, const LogMoment& moment) {
  if (const auto* utc = std::get_if<UtcTime>(&moment)) return reader.log_time_of(*utc);
  return std::optional(std::get<Nanoseconds>(moment));
}

}  // namespace yuragi
