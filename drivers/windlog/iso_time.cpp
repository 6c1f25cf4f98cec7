#include "drivers/windlog/iso_time.hpp"

#include <array>
#include <chrono>
#include <cstdint>
#include <ctime>

#include "drivers/windlog/format.hpp"

// Not by date::parse(): that takes "+2" and "14:00:00." and lets years run over, and refuses a leap second and more
// than nine decimals, which loggers write.

namespace yuragi::drivers::windlog {
namespace {

constexpr std::size_t kNanoDecimals = 9;

bool is_digit(char c) {
  return c >= '0' && c <= '9';
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
  if (digits.empty()) return std::nullopt;
  text.remove_prefix(digits.size());
  std::int64_t fraction_ns = 0;
  for (std::size_t i = 0; i < kNanoDecimals; ++i) {
    fraction_ns = 10 * fraction_ns + (i < digits.size() ? digits[i] - '0' : 0);
  }
  return whole_minutes + std::chrono::seconds(*second) + Nanoseconds(fraction_ns);
}

/// Takes Z, +02:00, +0200 or +02; an empty text is UTC.
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

}  // namespace

std::optional<UtcTime> parse_iso_time(std::string_view text) {
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
  constexpr std::int64_t kMaxDays = kMaxTime_ns / (24LL * 3600 * 1'000'000'000) - 2;
  const auto days = day->time_since_epoch().count();
  if (days < -kMaxDays || days > kMaxDays) return std::nullopt;
  return UtcTime(*day) + clock - *zone;
}

std::string iso_time_text(UtcTime moment) {
  const std::time_t time_s = std::chrono::floor<std::chrono::seconds>(moment).time_since_epoch().count();
  std::tm utc{};
  gmtime_r(&time_s, &utc);
  std::array<char, 32> text{};
  std::strftime(text.data(), text.size(), "%Y-%m-%dT%H:%M:%SZ", &utc);
  return text.data();
}

}  // namespace yuragi::drivers::windlog
