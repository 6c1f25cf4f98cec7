#include "daemon/tools/logs/log_time.hpp"

#include <algorithm>
#include <chrono>
#include <string>

#include "daemon/tools/csv/csv_words.hpp"
#include "drivers/decode/text_fields.hpp"

namespace yuragi::daemon::tools::logs {
namespace {

namespace decode = drivers::decode;

std::optional<std::chrono::sys_days> day_in(std::string_view day, std::string_view month, std::string_view year) {
  const auto time = csv::parse_time(std::string(day) + "/" + std::string(month) + "/" + std::string(year),
                                    csv::TimeFormat::kDayFirst);
  if (!time) return std::nullopt;
  return std::chrono::floor<std::chrono::days>(time->clock);
}

/// The field "c" of a tag block: seconds since 1970, or milliseconds.
std::optional<csv::Time> tag_block_time(std::string_view prefix) {
  for (const std::string_view key : {"\\c:", ",c:"}) {
    const auto at = prefix.find(key);
    if (at == std::string_view::npos) continue;
    const std::string_view rest = prefix.substr(at + key.size());
    const std::string_view number = rest.substr(0, rest.find_first_not_of("0123456789"));
    if (const auto format = csv::guess_count_format(number)) return csv::parse_time(number, *format);
  }
  return std::nullopt;
}

std::optional<csv::Time> time_in(std::string_view text, csv::TimeFormat format) {
  if (format != csv::TimeFormat::kAuto) return csv::parse_time(text, format);
  if (const auto compact = csv::parse_time(text, csv::TimeFormat::kCompact); compact && text.size() >= 12)
    return compact;
  if (const auto count = csv::guess_count_format(text)) {
    return *count == csv::TimeFormat::kSeconds ? std::nullopt : csv::parse_time(text, *count);
  }
  return csv::parse_time(text, csv::TimeFormat::kIso);
}

}  // namespace

std::optional<Nanoseconds> time_of_day_in(std::string_view text) {
  if (text.size() < 6) return std::nullopt;
  const bool has_colons = text[2] == ':';
  const std::string clock = has_colons ? std::string(text)
                                       : std::string(text.substr(0, 2)) + ":" + std::string(text.substr(2, 2)) + ":" +
                                             std::string(text.substr(4));
  const auto time = csv::parse_time("2000-01-01 " + clock, csv::TimeFormat::kIso);
  constexpr std::chrono::sys_days kDay = std::chrono::year(2000) / 1 / 1;
  if (!time || time->utc_offset) return std::nullopt;
  return time->clock - UtcTime(kDay);
}

bool NmeaClock::take(std::string_view line) {
  const auto sentence = decode::sentence_of(line, decode::WhenMissing::kAccept);
  if (!sentence || sentence->size() < 6) return false;
  const decode::TextFields fields = decode::split_fields(*sentence, ',');
  const std::string_view name = fields[0].size() >= 3 ? fields[0].substr(fields[0].size() - 3) : std::string_view();
  std::string_view time = fields[1];
  if (name == "RMC") {
    if (fields[2] != "A" || fields[9].size() != 6) return false;
    day_ = day_in(fields[9].substr(0, 2), fields[9].substr(2, 2), fields[9].substr(4, 2));
  } else if (name == "ZDA") {
    day_ = day_in(fields[2], fields[3], fields[4]);
  } else if (name == "GLL") {
    time = fields[5];
  } else if (name != "GGA") {
    return false;
  }
  const auto time_of_day = time_of_day_in(time);
  return day_ && time_of_day && set_time_of_day(*time_of_day);
}

bool NmeaClock::set_time_of_day(Nanoseconds time_of_day) {
  // A time alone, shortly after midnight, is of the next day.
  constexpr Nanoseconds kHalfDay = std::chrono::hours(12);
  UtcTime time = UtcTime(*day_) + time_of_day;
  if (now_ && *now_ - time > kHalfDay && *now_ - time < 2 * kHalfDay) {
    *day_ += std::chrono::days(1);
    time += 2 * kHalfDay;
  }
  now_ = time;
  return true;
}

std::optional<csv::Time> leading_time(std::string_view prefix, csv::TimeFormat format) {
  if (const auto time = tag_block_time(prefix)) return time;
  constexpr std::string_view kAround = " \t,;|>[](){}\"'\x02";
  const auto begin = prefix.find_first_not_of(kAround);
  if (begin == std::string_view::npos) return std::nullopt;
  prefix = prefix.substr(begin, prefix.find_last_not_of(kAround) - begin + 1);
  if (const auto time = time_in(prefix, format)) return time;
  // More can follow the time: a port, a priority.
  for (const char separator : {';', ',', '\t', ']', ')'}) {
    const std::string_view first = csv::without_blanks(prefix.substr(0, prefix.find(separator)));
    if (const auto time = time_in(first, format)) return time;
  }
  // Or words: the first two are date and time of the day, or the first one is both.
  const auto first_end = std::min(prefix.find(' '), prefix.size());
  const auto second_end = std::min(prefix.find(' ', std::min(first_end + 1, prefix.size())), prefix.size());
  if (const auto time = time_in(prefix.substr(0, second_end), format)) return time;
  const std::string_view first = prefix.substr(0, first_end);
  if (first.find(':') == std::string_view::npos && !csv::guess_count_format(first)) return std::nullopt;
  return time_in(first, format);
}

}  // namespace yuragi::daemon::tools::logs
