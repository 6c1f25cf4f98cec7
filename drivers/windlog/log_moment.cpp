#include "drivers/windlog/log_moment.hpp"

#include <charconv>
#include <string>

#include "drivers/windlog/format.hpp"
#include "drivers/windlog/iso_time.hpp"
#include "drivers/windlog/windlog_reader.hpp"

namespace yuragi::drivers::windlog {
namespace {

constexpr std::string_view kHelp =
    R"(; give seconds from the beginning (90) or a moment (2018-07-20T14:05:00Z; UTC if it has no zone))";

}  // namespace

Result<LogMoment, Failure> parse_log_moment(std::string_view text) {
  if (text.empty()) return LogMoment(Nanoseconds{0});
  double from_s = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), from_s);
  if (error == std::errc{} && end == text.data() + text.size()) {
    if (!(from_s >= 0.0) || from_s > seconds(Nanoseconds(kMaxTime_ns))) {
      return Failure{"\"" + std::string(text) + "\" is not in a recording" + std::string(kHelp), FailureKind::kUsage};
    }
    return LogMoment(from_seconds(from_s));
  }
  const auto moment = parse_iso_time(text);
  if (!moment) return Failure{"\"" + std::string(text) + "\" is not a time" + std::string(kHelp), FailureKind::kUsage};
  return LogMoment(*moment);
}

Result<std::optional<Nanoseconds>, Failure> log_time_of(Reader& reader, const LogMoment& moment) {
  if (const auto* utc = std::get_if<UtcTime>(&moment)) return reader.log_time_of(*utc);
  return std::optional(std::get<Nanoseconds>(moment));
}

}  // namespace yuragi::drivers::windlog
