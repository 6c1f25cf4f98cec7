#include "daemon/tools/csv/csv_time.hpp"

#include <array>
#include <chrono>
#include <limits>
#include <string>

#include "drivers/windlog/format.hpp"

namespace yuragi {
namespace {

constexpr int kNanoDecimals = 9;
constexpr int kNanoDecimalsOfMs = 6;

bool is_digit(char c) {
  return c >= '0' && c <= '9';
}

std::optional<UtcTime> utc_if_recordable(std::optional<std::int64_t> ns) {
  if (!ns || *ns < -windlog::kMaxTime_ns || *ns > windlog::kMaxTime_ns) return std::nullopt;
  return UtcTime(Nanoseconds(*ns));
}

/// Takes a number of `width` digits off the front of a text.
std::optional<int> take_digits(std::string_view& text, std::size_t width) {
  if (text.size() < width) return std::nullopt;
  int value = 0;
  for (const char c : text.substr(0, width)) {
    if (!is_digit(c)) return std::nullopt;
    value = 10 * value + (c - '0');
  }
  text.remove_prefix(width);
  return value;
}

/// Takes one of some signs off the front of a text.
bool take_sign(std::string_view& text, std::string_view signs) {
  if (text.empty() || signs.find(text.front()) == std::string_view::npos) return false;
  text.remove_prefix(1);
  return true;
}

void skip_spaces(std::string_view& text) {
  while (take_sign(text, " ")) {
  }
}

/// 2018-07-20, or with slashes.
std::optional<std::chrono::sys_days> take_day(std::string_view& text) {
  const auto year = take_digits(text, 4);
  if (!year || !take_sign(text, "-/")) return std::nullopt;
  const auto month = take_digits(text, 2);
  if (!month || !take_sign(text, "-/")) return std::nullopt;
  const auto day = take_digits(text, 2);
  if (!day) return std::nullopt;
  const auto date = std::chrono::year(*year) / *month / *day;
  if (!date.ok()) return std::nullopt;
  return std::chrono::sys_days(date);
}

/// 14:00, 14:00:00 or 14:00:00.123456789.
std::optional<Nanoseconds> take_clock(std::string_view& text) {
  const auto hour = take_digits(text, 2);
  if (!hour || *hour > 23 || !take_sign(text, ":")) return std::nullopt;
  const auto minute = take_digits(text, 2);
  if (!minute || *minute > 59) return std::nullopt;
  const Nanoseconds whole_minutes = std::chrono::hours(*hour) + std::chrono::minutes(*minute);
  if (!take_sign(text, ":")) return whole_minutes;

  // A leap second is the first of the next minute.
  const auto second = take_digits(text, 2);
  if (!second || *second > 60) return std::nullopt;
  if (!take_sign(text, ".,")) return whole_minutes + std::chrono::seconds(*second);
  const std::string_view digits = text.substr(0, text.find_first_not_of("0123456789"));
  const auto fraction_ns = parse_decimal("0." + std::string(digits), kNanoDecimals);
  if (digits.empty() || !fraction_ns) return std::nullopt;
  text.remove_prefix(digits.size());
  return whole_minutes + std::chrono::seconds(*second) + Nanoseconds(*fraction_ns);
}

/// Z, +02:00, +0200 or +02; nothing is UTC.
std::optional<Nanoseconds> take_zone(std::string_view& text) {
  if (text.empty() || take_sign(text, "Zz")) return Nanoseconds{0};
  const int sign = text.front() == '-' ? -1 : 1;
  if (!take_sign(text, "+-")) return std::nullopt;
  const auto hours = take_digits(text, 2);
  if (!hours || *hours > 14) return std::nullopt;
  if (text.empty()) return sign * std::chrono::hours(*hours);
  take_sign(text, ":");
  const auto minutes = take_digits(text, 2);
  if (!minutes || *minutes > 59) return std::nullopt;
  return sign * (std::chrono::hours(*hours) + std::chrono::minutes(*minutes));
}

std::optional<UtcTime> parse_iso(std::string_view text) {
  const auto day = take_day(text);
  if (!day) return std::nullopt;
  Nanoseconds clock{0};
  if (take_sign(text, "Tt ")) {
    skip_spaces(text);
    const auto taken = take_clock(text);
    if (!taken) return std::nullopt;
    clock = *taken;
  }
  skip_spaces(text);
  const auto zone = take_zone(text);
  if (!zone || !text.empty()) return std::nullopt;

  // A date of four digits can be too far for nanoseconds.
  constexpr std::int64_t kMaxDays = windlog::kMaxTime_ns / (24LL * 3600 * 1'000'000'000) - 2;
  const auto days = day->time_since_epoch().count();
  if (days < -kMaxDays || days > kMaxDays) return std::nullopt;
  return UtcTime(*day) + clock - *zone;
}

}  // namespace

std::string_view name_of(CsvTimeFormat format) {
  static constexpr std::array<std::string_view, 5> kNames = {"auto", "iso", "unix", "unix-ms", "seconds"};
  return kNames.at(static_cast<std::size_t>(format));
}

CsvTimeFormat guess_time_format(std::string_view text) {
  const auto whole = parse_decimal(text, 0);
  if (!whole) return CsvTimeFormat::kIso;
  constexpr std::int64_t kUnixFrom = 100'000'000;        // 1973 in seconds: no recording lasts so long
  constexpr std::int64_t kUnixMsFrom = 100'000'000'000;  // 1973 in milliseconds, and beyond 5000 in seconds
  if (*whole >= kUnixMsFrom) return CsvTimeFormat::kUnixMs;
  return *whole >= kUnixFrom ? CsvTimeFormat::kUnix : CsvTimeFormat::kSeconds;
}

std::optional<std::int64_t> parse_decimal(std::string_view text, int decimals) {
  const bool is_negative = !text.empty() && text.front() == '-';
  if (is_negative || (!text.empty() && text.front() == '+')) text.remove_prefix(1);

  // Digits are taken one by one until the wanted decimals are there; a fraction that is too short counts as zeros.
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

std::optional<UtcTime> parse_time(std::string_view text, CsvTimeFormat format) {
  switch (format) {
    case CsvTimeFormat::kUnix:
    case CsvTimeFormat::kSeconds:
      return utc_if_recordable(parse_decimal(text, kNanoDecimals));
    case CsvTimeFormat::kUnixMs:
      return utc_if_recordable(parse_decimal(text, kNanoDecimalsOfMs));
    case CsvTimeFormat::kIso:
      return parse_iso(text);
    case CsvTimeFormat::kAuto:
      break;
  }
  return std::nullopt;
}

}  // namespace yuragi
