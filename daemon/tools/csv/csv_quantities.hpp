#pragma once

#include <cstdio>

#include "daemon/tools/csv/csv_export.hpp"

namespace yuragi::daemon::tools::csv {

/// Writes what stations reported besides the wind as CSV: time_utc (the beginning of the second, in ISO 8601), sensor,
/// and a column for each of wind::kStationQuantities, empty if it was not reported. `ExportReport::skipped` counts
/// rows that cannot be such. `out` is not closed. Fails as the reader does, or if `out` cannot be written to.
/// Thread-safe: yes, with separate readers.
Result<ExportReport, Failure> export_quantities_csv(const drivers::windlog::Reader& reader, const ExportRange& range,
                                                    std::FILE* out);

}  // namespace yuragi::daemon::tools::csv
