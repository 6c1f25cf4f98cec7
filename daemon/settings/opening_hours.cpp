#include "daemon/settings/opening_hours.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <chrono>
#include <optional>

#include <fmt/format.h>

namespace yuragi::daemon::settings {
namespace {

/// Longer than any opening hours; how long reading them takes is bounded by it.
constexpr std::size_t kMaxHours = 1000;
constexpr std::size_t kMinutesPerDay = std::size_t{24} * 60;
constexpr std::size_t kDays = 7;
constexpr std::array<std::string_view, kDays> kDayNames = {"Mon", "Tue", "Wed", "Thu", "Fri", "Sat", "Sun"};

std::string_view without_spaces_around(std::string_view text) {
  const auto begin = text.find_first_not_of(" \t");
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(" \t") - begin + 1);
}

/// "Mon", in any case.
std::optional<std::size_t> parse_weekday(std::string_view text) {
  const auto lower = [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; };
  const auto found = std::ranges::find_if(
      kDayNames, [&](std::string_view name) { return std::ranges::equal(name, text, {}, lower, lower); });
  if (found == kDayNames.end()) return std::nullopt;
  return static_cast<std::size_t>(found - kDayNames.begin());
}

/// "18:00" in minutes, up to 24:00.
std::optional<std::size_t> parse_wall_clock(std::string_view text) {
  const auto number = [](std::string_view digits) -> std::optional<std::size_t> {
    std::size_t value = 0;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
    if (error != std::errc{} || end != digits.data() + digits.size()) return std::nullopt;
    return value;
  };
  const auto colon = text.find(':');
  if (colon > 2 || text.size() != colon + 3) return std::nullopt;  // npos is above 2
  const auto hour = number(text.substr(0, colon));
  const auto minute = number(text.substr(colon + 1));
  if (!hour || !minute || *minute > 59 || *hour > 24 || (*hour == 24 && *minute > 0)) return std::nullopt;
  return 60 * *hour + *minute;
}

/// "FROM-TO" with either end read by `parse`.
template <class Parse>
auto parse_range(std::string_view text, Parse parse) {
  const auto dash = text.find('-');
  const auto from = parse(without_spaces_around(text.substr(0, dash)));
  const auto to = dash == std::string_view::npos ? from : parse(without_spaces_around(text.substr(dash + 1)));
  return from && to ? std::optional(std::pair{*from, *to}) : std::nullopt;
}

/// One rule: the days, and the minutes from the beginning of each; those after 24:00 belong to the next day.
struct OpeningRule {
  std::size_t first_day = 0, last_day = kDays - 1;
  std::size_t from_min = 0, to_min = 0;
};

std::optional<OpeningRule> parse_rule(std::string_view text) {
  OpeningRule rule;
  // Days, if the rule begins with a letter: up to the first digit.
  if (const auto digit = text.find_first_of("0123456789"); digit != 0 && digit != std::string_view::npos) {
    const auto days = parse_range(without_spaces_around(text.substr(0, digit)), parse_weekday);
    if (!days) return std::nullopt;
    std::tie(rule.first_day, rule.last_day) = *days;
    text.remove_prefix(digit);
  }
  const auto hours = parse_range(text, parse_wall_clock);
  if (!hours || hours->first == hours->second || hours->first == kMinutesPerDay) return std::nullopt;
  std::tie(rule.from_min, rule.to_min) = *hours;
  if (rule.to_min < rule.from_min) rule.to_min += kMinutesPerDay;
  return rule;
}

}  // namespace

Result<OpeningHours, ParameterError> OpeningHours::parse(std::string_view hours, const std::string& zone) {
  OpeningHours result;
  const bool has_hours = !without_spaces_around(hours).empty();
  // Without rules the time zone is not needed.
  if (!has_hours && zone.empty()) return result;
  auto clock = LocalClock::of_zone(zone);
  if (!clock) return clock.error();
  result.clock_ = *clock;
  if (!has_hours) return result;
  if (hours.size() > kMaxHours) {
    return ParameterError{"hours", fmt::format("is too long: {} characters (maximum {})", hours.size(), kMaxHours)};
  }

  result.open_.reset();
  while (true) {
    const auto comma = hours.find(',');
    const std::string_view text = without_spaces_around(hours.substr(0, comma));
    const std::optional<OpeningRule> rule = parse_rule(text);
    if (!rule) {
      return ParameterError{"hours", fmt::format("has \"{}\"; allowed: FROM-TO, optionally after days, with "
                                                 "commas between: \"10:00-18:00\", \"Tue-Sun 10:00-18:00, Thu "
                                                 "18:00-21:00\"",
                                                 text)};
    }
    const std::size_t days = (rule->last_day + kDays - rule->first_day) % kDays + 1;
    for (std::size_t day = 0; day < days; ++day) {
      const std::size_t midnight = (rule->first_day + day) % kDays * kMinutesPerDay;
      for (std::size_t minute = rule->from_min; minute < rule->to_min; ++minute) {
        result.open_.set((midnight + minute) % kMinutesPerWeek);
      }
    }
    if (comma == std::string_view::npos) return result;
    hours.remove_prefix(comma + 1);
  }
}

std::size_t OpeningHours::minute_of_week(UtcTime now) const {
  // 1 January 1970 was a Thursday, three days after a Monday. The modulo is made positive for earlier times.
  constexpr auto kWeek = static_cast<std::int64_t>(kMinutesPerWeek);
  const std::int64_t minutes =
      std::chrono::floor<std::chrono::minutes>(clock_.since_1970(now)).count() + std::int64_t{3} * 24 * 60;
  return static_cast<std::size_t>((minutes % kWeek + kWeek) % kWeek);
}

bool OpeningHours::is_open(UtcTime now) const {
  return is_always_open() || open_.test(minute_of_week(now));
}

std::string OpeningHours::until_text(UtcTime now) const {
  const std::size_t begun = minute_of_week(now);
  for (std::size_t ahead = 1; ahead < kMinutesPerWeek; ++ahead) {
    const std::size_t minute = (begun + ahead) % kMinutesPerWeek;
    if (open_.test(minute) == open_.test(begun)) continue;
    const std::size_t of_day = minute % kMinutesPerDay;
    const std::string day = ahead >= kMinutesPerDay ? fmt::format("{} ", kDayNames[minute / kMinutesPerDay]) : "";
    return fmt::format("until {}{:02}:{:02}", day, of_day / 60, of_day % 60);
  }
  return {};
}

}  // namespace yuragi::daemon::settings
