#include "daemon/tools/csv/csv_quantities.hpp"

#include <string>
#include <utility>

#include "daemon/tools/csv/csv_text.hpp"
#include "engine/wind/station_quantities.hpp"

namespace yuragi::daemon::tools::csv {

Result<ExportReport, Failure> export_quantities_csv(const drivers::windlog::Reader& reader, const ExportRange& range,
                                                    std::FILE* out) {
  ExportReport report;
  Result<void, Failure> written;  // the first failure stays
  std::string text = "time_utc,sensor";
  for (const wind::StationQuantity& each : wind::kStationQuantities) text.append(",").append(each.name);
  text += '\n';

  const auto passed =
      reader.each_quantities(range.from, range.to, [&](const drivers::windlog::LoggedQuantities& logged) {
        append_utc(text, logged.quantities.time.utc);
        text += ',';
        append_text(text, reader.sensors()[logged.sensor].name);
        for (const wind::StationQuantity& each : wind::kStationQuantities) {
          text += ',';
          append_number(text, logged.quantities.*each.value);
        }
        text += '\n';
        ++report.written;
        if (text.size() < kCsvBufferBytes) return;
        if (auto done = write_out(text, out); !done && written) written = std::move(done);
      });
  if (!passed) return passed.error();
  if (written) written = write_out(text, out);
  if (!written) return written.error();
  report.skipped = *passed;
  return report;
}

}  // namespace yuragi::daemon::tools::csv
