#include "daemon/tools/csv/csv_export.hpp"

#include <cerrno>
#include <chrono>
#include <cstdint>
#include <iterator>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>

#include <fmt/format.h>

#include "daemon/tools/csv/csv_columns.hpp"

namespace yuragi::daemon::tools::csv {
namespace {

constexpr std::size_t kBufferBytes = 1 << 16;
constexpr std::int64_t kNanosecondsPerSecond = 1'000'000'000;

void append_utc(std::string& text, UtcTime time) {
  const auto day = std::chrono::floor<std::chrono::days>(time);
  const std::chrono::year_month_day ymd(day);
  const std::chrono::hh_mm_ss clock(time - day);
  fmt::format_to(std::back_inserter(text), "{:04}-{:02}-{:02}T{:02}:{:02}:{:02}.{:09}Z", static_cast<int>(ymd.year()),
                 static_cast<unsigned>(ymd.month()), static_cast<unsigned>(ymd.day()), clock.hours().count(),
                 clock.minutes().count(), clock.seconds().count(), clock.subseconds().count());
}

/// A text as a field, quoted where necessary. Line ends are replaced.
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

void append_row(std::string& text, const drivers::windlog::LoggedReading& logged, std::string_view sensor) {
  const std::int64_t log_ns = logged.log_time.count();
  append_utc(text, logged.reading.time.utc);
  fmt::format_to(std::back_inserter(text), ",{}.{:09},", log_ns / kNanosecondsPerSecond,
                 log_ns % kNanosecondsPerSecond);
  append_text(text, sensor);
  text += ',';
  append_number(text, logged.reading.speed_m_s);
  text += ',';
  append_number(text, logged.reading.direction_deg);
  text += ',';
  append_number(text, logged.reading.gust_m_s);
  text += ',';
  text += kQualityWords.at(static_cast<std::size_t>(logged.reading.quality));
  text += '\n';
}

}  // namespace

Result<CsvExportReport, Failure> export_csv(drivers::windlog::WindlogReader& reader, const CsvExportRange& range,
                                            std::FILE* out, const std::function<void(std::size_t)>& progress) {
  CsvExportReport report;
  std::string text(kExportedHeader);
  text += '\n';
  const auto flush = [&]() -> Result<void, Failure> {
    if (std::fwrite(text.data(), 1, text.size(), out) != text.size() || std::fflush(out) != 0) {
      return Failure{"cannot write the CSV: " + std::system_category().message(errno)};
    }
    text.clear();
    if (progress) progress(report.written);
    return {};
  };

  reader.seek(range.from);
  for (;;) {
    const auto logged = reader.next();
    if (!logged) return logged.error();
    if (!*logged || (*logged)->log_time >= range.to) break;
    append_row(text, **logged, reader.sensors()[(*logged)->sensor].name);
    ++report.written;
    if (text.size() < kBufferBytes) continue;
    if (const auto done = flush(); !done) return done.error();
  }
  if (const auto done = flush(); !done) return done.error();
  report.skipped = reader.skipped();
  return report;
}

}  // namespace yuragi::daemon::tools::csv
