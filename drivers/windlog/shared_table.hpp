#pragma once

#include <memory>

#include "drivers/windlog/sqlite.hpp"
#include "drivers/windlog/stored_readings.hpp"

namespace yuragi::drivers::windlog {

/// The content of a recording of version 1: one table has the readings of all sensors, with an index by session and
/// monotonic time. Whoever reads one sensor passes over the rows of the others. `database` must outlive it.
Result<std::unique_ptr<StoredReadings>, Failure> open_shared_table(sqlite::Database& database);

}  // namespace yuragi::drivers::windlog
