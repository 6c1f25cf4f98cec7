#include "daemon/tools/csv/csv_time.hpp"

#include <algorithm>
#include <limits>
#include <string>

#include "daemon/tools/csv/csv_words.hpp"
#include "drivers/windlog/format.hpp"

namespace yuragi::daemon::tools::csv {
namespace {

constexpr int kNanoDecimals = 9;

bool is_digit(char c) {
  return c >= '0' && c <= '9';
}

bool is_letter(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
}

std::optional<Time> time_if_recordable(std::optional<std::int64_t> ns) {
  if (!ns || *ns < -drivers::windlog::kMaxTime_ns || *ns > drivers::windlog::kMaxTime_ns) return std::nullopt;
  return Time{UtcTime(Nanoseconds(*ns)), Nanoseconds{0}};
}

/// Digits as they were written: "07" is 7 of two.
struct Digits {
  int value = 0;
  std::size_t count = 0;
};

/// Takes dates, clocks and zones off the front of a text.
class CalendarText {
 public:
  explicit CalendarText(std::string_view text) : rest_(without_blanks(text)) {}

  bool is_empty() const { return rest_.empty(); }

  std::optional<std::chrono::sys_days> take_day(TimeFormat format) {
    take_weekday();
    if (const auto month = take_month_name()) return take_after_month(*month);
    const auto first = take_digits();
    if (!first) return std::nullopt;
    constexpr int kYearPart = 10'000;
    constexpr int kMonthPart = 100;
    if (first->count == 8 && format == TimeFormat::kIso) {
      return day_of(first->value / kYearPart, first->value / kMonthPart % kMonthPart, first->value % kMonthPart);
    }
    if (first->count == 4) {
      if (format != TimeFormat::kIso || !take_any("-/. ")) return std::nullopt;
      if (const auto day = take_day_of_year(first->value)) return day;
      const auto month = take_month();
      if (!month || !take_any("-/. ")) return std::nullopt;
      const auto day = take_digits(2);
      return day ? day_of(first->value, *month, day->value) : std::nullopt;
    }
    if (first->count > 2) return std::nullopt;
    return take_after_short_number(first->value, format);
  }

  /// 14, 14:00, 14:00:00.5, 1400, 2:00 PM, 2:00p; blanks may stand for the colons.
  std::optional<Nanoseconds> take_clock() {
    const auto hour = take_digits();
    if (!hour || hour->count > 6) return std::nullopt;
    int parts[3] = {hour->value, 0, 0};
    if (hour->count > 2) {
      // 1400, 930, 140000
      const bool has_seconds = hour->count > 4;
      int value = hour->value;
      if (has_seconds) {
        parts[2] = value % 100;
        value /= 100;
      }
      parts[1] = value % 100;
      parts[0] = value / 100;
    } else {
      for (int i = 1; i < 3; ++i) {
        const bool goes_on = rest_.size() > 1 && (rest_[0] == ':' || rest_[0] == ' ') && is_digit(rest_[1]);
        if (!goes_on) break;
        rest_.remove_prefix(1);
        const auto next = take_digits(2);
        if (!next) return std::nullopt;
        parts[i] = next->value;
      }
    }
    Nanoseconds fraction{0};
    if (rest_.size() > 1 && (rest_[0] == '.' || rest_[0] == ',') && is_digit(rest_[1])) {
      rest_.remove_prefix(1);
      fraction = take_fraction();
    }
    if (!take_half_of_day(parts[0])) return std::nullopt;
    // A leap second is the first of the next minute; 24:00 is the next day's 00:00.
    if (parts[0] > 24 || parts[1] > 59 || parts[2] > 60) return std::nullopt;
    const Nanoseconds clock =
        std::chrono::hours(parts[0]) + std::chrono::minutes(parts[1]) + std::chrono::seconds(parts[2]) + fraction;
    if (clock > std::chrono::hours(24)) return std::nullopt;
    return clock;
  }

  /// Z, UTC, GMT, +02:00, +0200, +02, UTC+2; false if something else stands there.
  bool take_zone(std::optional<Nanoseconds>& offset) {
    skip_blanks();
    if (rest_.empty()) return true;
    const std::string text = lower(rest_);
    for (const std::string_view name : {"utc", "gmt", "z"}) {
      if (!text.starts_with(name)) continue;
      rest_.remove_prefix(name.size());
      offset = Nanoseconds{0};
      if (rest_.empty()) return true;
      break;
    }
    const bool is_behind = rest_.starts_with('-');
    if (!take_any("+-")) return false;
    const auto hours = take_digits(4);
    if (!hours || (hours->count == 3)) return false;
    int hour = hours->value;
    int minute = 0;
    if (hours->count == 4) {
      minute = hour % 100;
      hour /= 100;
    } else if (take_any(":")) {
      const auto minutes = take_digits(2);
      if (!minutes || minutes->count != 2) return false;
      minute = minutes->value;
    }
    if (hour > 14 || minute > 59 || !rest_.empty()) return false;
    offset = (is_behind ? -1 : 1) * (std::chrono::hours(hour) + std::chrono::minutes(minute));
    return true;
  }

  /// Takes the separator between a date and a clock time.
  bool take_separator() {
    if (!take_any("Tt ,;_:")) return false;
    skip_blanks();
    return true;
  }

 private:
  std::optional<Digits> take_digits(std::size_t most = 9) {
    Digits digits;
    while (!rest_.empty() && is_digit(rest_.front()) && digits.count < most) {
      digits.value = 10 * digits.value + (rest_.front() - '0');
      ++digits.count;
      rest_.remove_prefix(1);
    }
    if (digits.count == 0 || (!rest_.empty() && is_digit(rest_.front()))) return std::nullopt;
    return digits;
  }

  /// Three digits, from 1 to 365 or 366.
  std::optional<std::chrono::sys_days> take_day_of_year(int year) {
    if (rest_.size() < 3 || !std::ranges::all_of(rest_.substr(0, 3), is_digit)) return std::nullopt;
    if (rest_.size() > 3 && is_digit(rest_[3])) return std::nullopt;
    const auto digits = take_digits(3);
    const auto first = day_of(year, 1, 1);
    if (!digits || digits->value < 1 || !first) return std::nullopt;
    const std::chrono::sys_days day = *first + std::chrono::days(digits->value - 1);
    if (std::chrono::year_month_day(day).year() != std::chrono::year(year)) return std::nullopt;
    return day;
  }

  bool take_any(std::string_view signs) {
    if (rest_.empty() || signs.find(rest_.front()) == std::string_view::npos) return false;
    rest_.remove_prefix(1);
    return true;
  }

  void skip_blanks() {
    while (take_any(" \t")) {
    }
  }

  Nanoseconds take_fraction() {
    std::int64_t ns = 0;
    int count = 0;
    while (!rest_.empty() && is_digit(rest_.front())) {
      if (count < kNanoDecimals) ns = 10 * ns + (rest_.front() - '0');
      ++count;
      rest_.remove_prefix(1);
    }
    for (; count < kNanoDecimals; ++count) ns *= 10;
    return Nanoseconds(ns);
  }

  bool begins_with_letter() const { return !rest_.empty() && is_letter(rest_.front()); }

  void take_weekday() {
    if (!begins_with_letter()) return;
    static constexpr std::array<std::string_view, 7> kDays = {"mon", "tue", "wed", "thu", "fri", "sat", "sun"};
    if (rest_.size() < 4 || std::ranges::find(kDays, lower(rest_.substr(0, 3))) == kDays.end()) return;
    while (!rest_.empty() && is_letter(rest_.front())) rest_.remove_prefix(1);
    take_any(",");
    skip_blanks();
  }

  std::optional<int> take_month_name() {
    static constexpr std::array<std::string_view, 12> kMonths = {"jan", "feb", "mar", "apr", "may", "jun",
                                                                 "jul", "aug", "sep", "oct", "nov", "dec"};
    if (rest_.size() < 3 || !begins_with_letter()) return std::nullopt;
    const auto* const found = std::ranges::find(kMonths, lower(rest_.substr(0, 3)));
    if (found == kMonths.end()) return std::nullopt;
    while (!rest_.empty() && is_letter(rest_.front())) rest_.remove_prefix(1);
    take_any(".");
    return static_cast<int>(found - kMonths.begin()) + 1;
  }

  std::optional<int> take_month() {
    if (const auto name = take_month_name()) return name;
    const auto digits = take_digits(2);
    return digits ? std::optional(digits->value) : std::nullopt;
  }

  /// Jul 20, 2018
  std::optional<std::chrono::sys_days> take_after_month(int month) {
    skip_blanks();
    const auto day = take_digits(2);
    if (!day) return std::nullopt;
    take_any(",");
    skip_blanks();
    const auto year = take_year();
    return year ? day_of(*year, month, day->value) : std::nullopt;
  }

  /// 20/07/2018 or 07/20/2018, 20-Jul-2018
  std::optional<std::chrono::sys_days> take_after_short_number(int first, TimeFormat format) {
    if (!take_any("-/. ")) return std::nullopt;
    if (const auto month = take_month_name()) {
      take_any("-/. ");
      const auto year = take_year();
      return year ? day_of(*year, *month, first) : std::nullopt;
    }
    if (format == TimeFormat::kIso) return std::nullopt;
    const auto second = take_digits(2);
    if (!second || !take_any("-/. ")) return std::nullopt;
    const auto year = take_year();
    if (!year) return std::nullopt;
    return format == TimeFormat::kDayFirst ? day_of(*year, second->value, first) : day_of(*year, first, second->value);
  }

  std::optional<int> take_year() {
    const auto digits = take_digits(4);
    if (!digits || digits->count == 1 || digits->count == 3) return std::nullopt;
    if (digits->count == 4) return digits->value;
    constexpr int kFirstOfLastCentury = 70;
    return digits->value + (digits->value >= kFirstOfLastCentury ? 1900 : 2000);
  }

  static std::optional<std::chrono::sys_days> day_of(int year, int month, int day) {
    const auto date = std::chrono::year(year) / month / day;
    if (!date.ok()) return std::nullopt;
    return std::chrono::sys_days(date);
  }

  /// AM and PM; false if the hour is none of them.
  bool take_half_of_day(int& hour) {
    std::string_view rest = rest_;
    while (rest.starts_with(' ')) rest.remove_prefix(1);
    if (rest.empty()) return true;
    const char half = lower(rest.substr(0, 1)).front();
    if (half != 'a' && half != 'p') return true;
    rest.remove_prefix(1);
    if (rest.starts_with('.')) rest.remove_prefix(1);
    if (rest.starts_with('m') || rest.starts_with('M')) rest.remove_prefix(1);
    if (rest.starts_with('.')) rest.remove_prefix(1);
    if (!rest.empty() && is_letter(rest.front())) return false;
    rest_ = rest;
    if (hour < 1 || hour > 12) return false;
    hour = hour % 12 + (half == 'p' ? 12 : 0);
    return true;
  }

  std::string_view rest_;
};

std::optional<Time> on_day(std::chrono::sys_days day, Nanoseconds clock, std::optional<Nanoseconds> offset) {
  // A date of four digits can be too far for nanoseconds.
  constexpr std::int64_t kMaxDays = drivers::windlog::kMaxTime_ns / (24LL * 3600 * 1'000'000'000) - 3;
  const auto days = day.time_since_epoch().count();
  if (days < -kMaxDays || days > kMaxDays) return std::nullopt;
  return Time{UtcTime(day) + clock, offset};
}

/// "2018-07-20T14:00:00", with a blank for the T or a fraction or Z behind it, as nearly all programs write it. Nullopt
/// for anything else, which may be a time all the same.
std::optional<Time> parse_usual_iso(std::string_view text) {
  constexpr std::string_view kForm = "0000-00-00T00:00:00";
  if (text.size() < kForm.size()) return std::nullopt;
  for (std::size_t i = 0; i < kForm.size(); ++i) {
    const bool fits = kForm[i] == '0' ? is_digit(text[i]) : text[i] == kForm[i] || (kForm[i] == 'T' && text[i] == ' ');
    if (!fits) return std::nullopt;
  }
  const auto two = [text](std::size_t at) { return 10 * (text[at] - '0') + (text[at + 1] - '0'); };
  const std::chrono::year_month_day date(std::chrono::year(100 * two(0) + two(2)),
                                         std::chrono::month(static_cast<unsigned>(two(5))),
                                         std::chrono::day(static_cast<unsigned>(two(8))));
  const int hour = two(11);
  const int minute = two(14);
  const int second = two(17);
  if (!date.ok() || hour > 23 || minute > 59 || second > 59) return std::nullopt;
  std::int64_t fraction_ns = 0;
  std::size_t end = kForm.size();
  if (end < text.size() && text[end] == '.') {
    ++end;
    std::int64_t unit_ns = 100'000'000;
    for (; end < text.size() && is_digit(text[end]); ++end, unit_ns /= 10) fraction_ns += unit_ns * (text[end] - '0');
    if (text[end - 1] == '.') return std::nullopt;
  }
  std::optional<Nanoseconds> offset;
  if (end < text.size() && text[end] == 'Z') {
    offset = Nanoseconds{0};
    ++end;
  }
  if (end != text.size()) return std::nullopt;
  return on_day(
      std::chrono::sys_days(date),
      std::chrono::hours(hour) + std::chrono::minutes(minute) + std::chrono::seconds(second) + Nanoseconds(fraction_ns),
      offset);
}

std::optional<Time> parse_calendar(std::string_view text, TimeFormat format) {
  if (format == TimeFormat::kIso) {
    if (const auto usual = parse_usual_iso(text)) return usual;
  }
  CalendarText calendar(text);
  const auto day = calendar.take_day(format);
  if (!day) return std::nullopt;
  Nanoseconds clock{0};
  if (calendar.take_separator() && !calendar.is_empty()) {
    const auto taken = calendar.take_clock();
    if (!taken) return std::nullopt;
    clock = *taken;
  }
  std::optional<Nanoseconds> offset;
  if (!calendar.take_zone(offset)) return std::nullopt;
  return on_day(*day, clock, offset);
}

std::optional<Time> parse_compact(std::string_view text) {
  if (text.ends_with(".0")) text.remove_suffix(2);
  if (!std::ranges::all_of(text, is_digit)) return std::nullopt;
  if (text.size() != 8 && text.size() != 10 && text.size() != 12 && text.size() != 14) return std::nullopt;
  // What begins otherwise is a number of seconds.
  if (!text.starts_with("19") && !text.starts_with("20")) return std::nullopt;
  std::string written(text.substr(0, 8));
  for (std::size_t i = 8; i < text.size(); i += 2) {
    written += i == 8 ? ' ' : ':';
    written += text.substr(i, 2);
  }
  return parse_calendar(written, TimeFormat::kIso);
}

}  // namespace

std::string_view name_of(TimeFormat format) {
  static constexpr std::array<std::string_view, kCsvTimeFormatCount> kNames = {
      "auto", "iso", "day-first", "month-first", "compact", "unix", "unix-ms", "unix-us", "unix-ns", "seconds"};
  return kNames.at(static_cast<std::size_t>(format));
}

std::optional<TimeFormat> guess_count_format(std::string_view text) {
  const auto whole = parse_decimal(text, 0);
  if (!whole) return std::nullopt;
  constexpr std::int64_t kUnixFrom = 100'000'000;                // 1973 in seconds: no recording lasts so long
  constexpr std::int64_t kUnixMsFrom = 100'000'000'000;          // 1973 in milliseconds, and beyond 5000 in seconds
  constexpr std::int64_t kUnixUsFrom = 100'000'000'000'000;      // the same in microseconds
  constexpr std::int64_t kUnixNsFrom = 100'000'000'000'000'000;  // and in nanoseconds
  if (*whole >= kUnixNsFrom) return TimeFormat::kUnixNs;
  if (*whole >= kUnixUsFrom) return TimeFormat::kUnixUs;
  if (*whole >= kUnixMsFrom) return TimeFormat::kUnixMs;
  return *whole >= kUnixFrom ? TimeFormat::kUnix : TimeFormat::kSeconds;
}

std::optional<std::int64_t> parse_decimal(std::string_view text, int decimals) {
  const bool is_negative = !text.empty() && text.front() == '-';
  if (is_negative || (!text.empty() && text.front() == '+')) text.remove_prefix(1);

  // Digits are taken one by one up to the number of decimals; a shorter fraction is filled up with zeros.
  std::int64_t value = 0;
  bool in_fraction = false;
  bool has_digits = false;
  int missing = decimals;
  const auto append = [&value](int digit) {
    if (value > (std::numeric_limits<std::int64_t>::max() - digit) / 10) return false;
    value = 10 * value + digit;
    return true;
  };
  for (const char c : text) {
    if ((c == '.' || c == ',') && !in_fraction) {
      in_fraction = true;
      continue;
    }
    if (!is_digit(c)) return std::nullopt;
    has_digits = true;
    if (in_fraction && missing == 0) continue;
    if (!append(c - '0')) return std::nullopt;
    if (in_fraction) --missing;
  }
  for (; missing > 0; --missing) {
    if (!append(0)) return std::nullopt;
  }
  if (!has_digits) return std::nullopt;
  return is_negative ? -value : value;
}

std::optional<Time> parse_time(std::string_view text, TimeFormat format) {
  switch (format) {
    case TimeFormat::kUnix:
    case TimeFormat::kSeconds:
      return time_if_recordable(parse_decimal(text, kNanoDecimals));
    case TimeFormat::kUnixMs:
      return time_if_recordable(parse_decimal(text, kNanoDecimals - 3));
    case TimeFormat::kUnixUs:
      return time_if_recordable(parse_decimal(text, kNanoDecimals - 6));
    case TimeFormat::kUnixNs:
      return time_if_recordable(parse_decimal(text, 0));
    case TimeFormat::kCompact:
      return parse_compact(text);
    case TimeFormat::kIso:
    case TimeFormat::kDayFirst:
    case TimeFormat::kMonthFirst:
      return parse_calendar(text, format);
    case TimeFormat::kAuto:
      break;
  }
  return std::nullopt;
}

bool has_date(std::string_view text) {
  if (const auto count = guess_count_format(text)) {
    return *count != TimeFormat::kSeconds || parse_compact(text).has_value();
  }
  return parse_calendar(text, TimeFormat::kIso) || parse_calendar(text, TimeFormat::kDayFirst) ||
         parse_calendar(text, TimeFormat::kMonthFirst);
}

}  // namespace yuragi::daemon::tools::csv
