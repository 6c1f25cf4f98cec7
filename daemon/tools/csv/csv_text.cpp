#include "daemon/tools/csv/csv_text.hpp"

#include <cerrno>
#include <chrono>
#include <cstdint>
#include <iterator>
#include <system_error>

#include <fmt/format.h>

namespace yuragi::daemon::tools::csv {

void append_utc(std::string& text, UtcTime time) {
  const auto day = std::chrono::floor<std::chrono::days>(time);
  const std::chrono::year_month_day ymd(day);
  const std::chrono::hh_mm_ss clock(time - day);
  fmt::format_to(std::back_inserter(text), "{:04}-{:02}-{:02}T{:02}:{:02}:{:02}.{:09}Z", static_cast<int>(ymd.year()),
                 static_cast<unsigned>(ymd.month()), static_cast<unsigned>(ymd.day()), clock.hours().count(),
                 clock.minutes().count(), clock.seconds().count(), clock.subseconds().count());
}

void append_log_time(std::string& text, Nanoseconds log_time) {
  constexpr std::int64_t kNanosecondsPerSecond = 1'000'000'000;
  fmt::format_to(std::back_inserter(text), "{}.{:09}", log_time.count() / kNanosecondsPerSecond,
                 log_time.count() % kNanosecondsPerSecond);
}

void append_text(std::string& text, std::string_view field) {
  if (field.find_first_of(",\"\n\r") == std::string_view::npos) {
    text += field;
    return;
  }
  text += '"';
  for (const char c : field) {
    if (c == '"') text += '"';
    text += c == '\n' || c == '\r' ? ' ' : c;
  }
  text += '"';
}

void append_number(std::string& text, const std::optional<double>& number) {
  if (number) fmt::format_to(std::back_inserter(text), "{}", *number);
}

Result<void, Failure> write_out(std::string& text, std::FILE* out) {
  const bool is_written = std::fwrite(text.data(), 1, text.size(), out) == text.size() && std::fflush(out) == 0;
  text.clear();
  if (is_written) return {};
  return Failure{"cannot write the CSV: " + std::system_category().message(errno)};
}

}  // namespace yuragi::daemon::tools::csv
