#include "daemon/tools/csv/csv_time.hpp"

#include <array>
#include <limits>

#include "drivers/windlog/format.hpp"
#include "drivers/windlog/iso_time.hpp"

namespace yuragi::daemon::tools::csv {
namespace {

constexpr int kNanoDecimals = 9;
constexpr int kNanoDecimalsOfMs = 6;

bool is_digit(char c) {
  return c >= '0' && c <= '9';
}

std::optional<UtcTime> utc_if_recordable(std::optional<std::int64_t> ns) {
  if (!ns || *ns < -drivers::windlog::kMaxTime_ns || *ns > drivers::windlog::kMaxTime_ns) return std::nullopt;
  return UtcTime(Nanoseconds(*ns));
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

std::optional<UtcTime> parse_time(std::string_view text, CsvTimeFormat format) {
  switch (format) {
    case CsvTimeFormat::kUnix:
    case CsvTimeFormat::kSeconds:
      return utc_if_recordable(parse_decimal(text, kNanoDecimals));
    case CsvTimeFormat::kUnixMs:
      return utc_if_recordable(parse_decimal(text, kNanoDecimalsOfMs));
    case CsvTimeFormat::kIso:
      return drivers::windlog::parse_iso_time(text);
    case CsvTimeFormat::kAuto:
      break;
  }
  return std::nullopt;
}

}  // namespace yuragi::daemon::tools::csv
