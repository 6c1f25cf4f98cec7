#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include "drivers/windlog/sqlite.hpp"
#include "drivers/windlog/stored_readings.hpp"

namespace yuragi::drivers::windlog {

/// Streams of readings as one, in the order of log time. `database`, of which all of them are read as of one moment,
/// must outlive it; nullptr for one stream. Thread-safe: no. Realtime-safe: no.
class MergedReadings {
 public:
  MergedReadings(sqlite::Database* database, std::vector<std::unique_ptr<ReadingBlocks>> streams);

  /// As Reader's.
  Result<std::optional<LoggedReading>, Failure> next();
  void seek(Nanoseconds log_time);

  /// Rows that cannot be readings, since the beginning or the last seek().
  std::size_t skipped() const { return skipped_; }

 private:
  struct Stream {
    std::unique_ptr<ReadingBlocks> blocks;
    std::vector<LoggedReading> block = {};
    std::size_t next = 0;

    bool is_used_up() const { return next == block.size(); }
  };

  Result<void, Failure> refill();

  sqlite::Database* database_;
  std::vector<Stream> streams_;
  std::size_t ended_ = 0;  ///< streams that had no more readings when they were read last
  std::size_t skipped_ = 0;
};

}  // namespace yuragi::drivers::windlog
