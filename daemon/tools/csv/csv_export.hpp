#pragma once

#include <cstddef>
#include <cstdio>
#include <functional>

#include "drivers/windlog/windlog_reader.hpp"
#include "engine/base/result.hpp"
#include "engine/base/time.hpp"

namespace yuragi::daemon::tools::csv {

/// The part of a recording to export, in log time: from `from` on, and before `to`.
struct ExportRange {
  Nanoseconds from{0};
  Nanoseconds to = Nanoseconds::max();
};

struct ExportReport {
  std::size_t written = 0;  ///< readings
  std::size_t rows = 0;     ///< lines of the table without its header: fewer than readings if they are means
  std::size_t skipped = 0;  ///< rows of the recording that are not valid readings
};

/// Writes readings as CSV (kExportedHeader): UTC in ISO 8601 to the nanosecond, log time, numbers with as many
/// digits as give the same number when read, always with a decimal point; empty if there is no value. `yuragi
/// import` reads the same readings from it.
///
/// `out` is not closed. `progress` is called now and then with the number of rows. Fails as the reader does, or if
/// `out` cannot be written to. Thread-safe: yes, with separate readers.
Result<ExportReport, Failure> export_csv(drivers::windlog::Reader& reader, const ExportRange& range, std::FILE* out,
                                         const std::function<void(std::size_t)>& progress = {});

}  // namespace yuragi::daemon::tools::csv
