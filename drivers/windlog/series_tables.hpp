#pragma once

#include <memory>

#include "drivers/windlog/sqlite.hpp"
#include "drivers/windlog/stored_readings.hpp"

namespace yuragi::drivers::windlog {

/// The content of a recording of version 2: each sensor's name has a table of its own, by time, which is read from any
/// time on without a look at the others. `database` must outlive it.
Result<std::unique_ptr<StoredReadings>, Failure> open_series_tables(sqlite::Database& database);

}  // namespace yuragi::drivers::windlog
