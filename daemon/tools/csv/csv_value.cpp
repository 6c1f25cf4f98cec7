#include "daemon/tools/csv/csv_value.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "daemon/tools/csv/csv_words.hpp"

namespace yuragi::daemon::tools::csv {
namespace {

bool is_one_of(double value, std::initializer_list<double> marks) {
  return std::ranges::any_of(marks, [value](double mark) { return std::abs(value - mark) < 1e-6 * mark; });
}

/// Returns true if it is a realistic value for such a column, in base units.
bool can_be(Role role, double base) {
  constexpr double kMaxSpeed_m_s = 60.0;
  switch (dimension_of(role)) {
    case Dimension::kSpeed:
      return std::abs(base) < kMaxSpeed_m_s && (base >= 0.0 || (role != Role::kSpeed && role != Role::kGust));
    case Dimension::kDirection:
      return base >= -180.0 && base <= 360.0;
    case Dimension::kTemperature:
      return base > -65.0 && base < 60.0;
    case Dimension::kPressure:
      return base >= 300.0 && base <= 1100.0;
    case Dimension::kHumidity:
      return base >= 0.0 && base <= 110.0;
    case Dimension::kRain:
    case Dimension::kRainRate:
      return base >= 0.0 && base < 999.0;
    case Dimension::kTime:
    case Dimension::kNone:
      break;
  }
  return true;
}

}  // namespace

std::optional<Number> parse_number(std::string_view text, Dimension dimension) {
  if (text.starts_with('+')) text.remove_prefix(1);
  constexpr std::size_t kLongest = 40;
  if (text.size() > kLongest) return std::nullopt;
  std::array<char, kLongest> plain{};
  std::ranges::transform(text, plain.begin(), [](char c) { return c == ',' ? '.' : c; });
  double value = 0.0;
  const char* const end = plain.data() + text.size();
  const auto [stop, error] = std::from_chars(plain.data(), end, value);
  if (error != std::errc{} || !std::isfinite(value)) return std::nullopt;
  Number number{value, std::nullopt};
  if (stop == end) return number;
  const std::string_view rest = without_blanks(text.substr(static_cast<std::size_t>(stop - plain.data())));
  // "270°" needs no unit.
  if (dimension == Dimension::kDirection && (rest == "\xC2\xB0" || rest == "\xB0")) return number;
  number.unit = find_unit(dimension, rest);
  if (!number.unit) return std::nullopt;
  return number;
}

bool is_missing_word(std::string_view text) {
  static constexpr auto kWords = std::to_array<std::string_view>(
      {"",      "nan",  "na",        "n/a",         "null",    "none",    "m",      "mm",      "vrb",
       "var",   "calm", "variable",  "unavailable", "unknown", "missing", "nodata", "no data", "invalid",
       "error", "\\n",  "*",         "**",          "***",     "?",       ".",      "#n/a",    "inf",
       "-inf",  "ovr",  "undefined", "静穏",        "×",       "///"});
  constexpr std::size_t kLongest = 12;
  if (text.size() > kLongest) return false;
  if (text.find_first_not_of('-') == std::string_view::npos || text.find_first_not_of('/') == std::string_view::npos)
    return true;
  // Most fields are numbers.
  if (text.front() >= '0' && text.front() <= '9') return false;
  return std::ranges::find(kWords, lower(text)) != kWords.end();
}

bool is_missing_number(Role role, double value, double base) {
  if (role == Role::kElapsed || can_be(role, base)) return false;
  if (role == Role::kDirection && value == 990.0) return true;
  // Above zero, two digits may be a wind in a storm: is_possible_mark().
  constexpr double kMinMark = 888.0;
  if (value > 0.0 && value < kMinMark) return false;
  return is_one_of(std::abs(value), {99.0, 99.9, 99.99, 888.0, 999.0, 999.9, 999.99, 6999.0, 7999.0, 8888.0, 9999.0,
                                     9999.9, 9999.99, 32767.0, 32768.0, 65535.0, 99999.0, 99999.9, 999999.0});
}

bool is_possible_mark(Role role, double value) {
  if (role == Role::kHumidity) return is_one_of(value, {255.0});
  return is_one_of(value, {99.0, 99.9, 99.99, 255.0, 327.67, 655.35, 409.5, 102.3, 511.0, 1023.0});
}

}  // namespace yuragi::daemon::tools::csv
