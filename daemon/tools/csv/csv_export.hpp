#pragma once

#include <cstddef>
#include <cstdio>
#include <functional>

#include "drivers/windlog/windlog_reader.hpp"
#include "engine/base/result.hpp"
#include "engine/base/time.hpp"

namespace yuragi {

/// Which part of a recording goes out, in log time: from `from` on, and before `to`.
struct CsvExportRange {
  Nanoseconds from{0};
  Nanoseconds to = Nanoseconds::max();
};

struct CsvExportReport {
  std::size_t written = 0;
  std::size_t skipped = 0;  ///< rows that cannot be readings
};

/// Writes readings as CSV (kExportedHeader): UTC in ISO 8601 to the nanosecond, log time, numbers with all the digits
/// that give back the same number, always with a decimal point; empty where there is no value. What `yuragi import`
/// makes of it are the same readings.
///
/// `out` is written to and stays the caller's. `progress` is told now and then how many rows there are. Fails as the
/// reader does, or where `out` takes no more. Thread-safe: yes, with a reader of one's own.
Result<CsvExportReport, Failure> export_csv(WindlogReader& reader, const CsvExportRange& range, std::FILE* out,
                                            const std::function<void(std::size_t)>& progress = {});

}  // namespace yuragi
