#include "daemon/tools/csv/csv_export.hpp"

#include <string>
#include <string_view>

#include "daemon/tools/csv/csv_columns.hpp"
#include "daemon/tools/csv/csv_text.hpp"

namespace yuragi::daemon::tools::csv {
namespace {

void append_row(std::string& text, const drivers::windlog::LoggedReading& logged, std::string_view sensor) {
  append_utc(text, logged.reading.time.utc);
  text += ',';
  append_log_time(text, logged.log_time);
  text += ',';
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

Result<ExportReport, Failure> export_csv(drivers::windlog::Reader& reader, const ExportRange& range, std::FILE* out,
                                         const std::function<void(std::size_t)>& progress) {
  ExportReport report;
  std::string text(kExportedHeader);
  text += '\n';
  const auto flush = [&]() -> Result<void, Failure> {
    if (const auto done = write_out(text, out); !done) return done.error();
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
    ++report.rows;
    if (text.size() < kCsvBufferBytes) continue;
    if (const auto done = flush(); !done) return done.error();
  }
  if (const auto done = flush(); !done) return done.error();
  report.skipped = reader.skipped();
  return report;
}

}  // namespace yuragi::daemon::tools::csv
