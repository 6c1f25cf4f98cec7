#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "drivers/windlog/logged.hpp"
#include "engine/base/result.hpp"
#include "engine/base/time.hpp"

namespace yuragi::drivers::windlog {

/// Readings in the order of log time, in blocks. Thread-safe: no. Realtime-safe: no; it reads a file.
class ReadingBlocks {
 public:
  virtual ~ReadingBlocks() = default;

  /// Makes the next block begin with the first reading at or after a log time.
  virtual void seek(Nanoseconds log_time) = 0;

  /// Replaces `block` by the next readings, and adds the rows that cannot be readings to `skipped`. Leaves the block
  /// empty at the end, until more has been recorded. After a failure, too; the next call tries the same place again.
  virtual Result<void, Failure> read(std::vector<LoggedReading>& block, std::size_t& skipped) = 0;
};

/// Takes the other quantities of stations, in the order of log time.
using UseQuantities = std::function<void(const LoggedQuantities&)>;

/// A recording's content as a version of the format (format.hpp) stores it. A file is not trusted: impossible content
/// is a failure. Thread-safe: no. Realtime-safe: no.
class StoredReadings {
 public:
  virtual ~StoredReadings() = default;

  /// As of the opening: sessions that have readings, in order, and the sensors of all sessions.
  std::vector<LoggedSession> sessions;
  std::vector<LoggedSensor> sensors;
  /// When the first session was begun, of a file that has quantities and no reading; otherwise nullopt.
  std::optional<UtcTime> begun_without_readings;

  /// Of a series of files, those that are damaged, each with the span that is left out, as sentences. Damage found
  /// while reading is added.
  virtual std::vector<std::string> damage() const { return {}; }

  /// The readings of those sensors (one flag for each of `sensors`): streams of blocks, to be merged by log time.
  virtual Result<std::vector<std::unique_ptr<ReadingBlocks>>, Failure> blocks(
      const std::vector<bool>& of_sensors) const = 0;

  /// The configuration text of a session.
  virtual Result<std::string, Failure> configuration(std::int64_t session) const = 0;

  /// Returns the log time of the first reading at or after a moment; nullopt if all are before it.
  virtual Result<std::optional<Nanoseconds>, Failure> log_time_of(UtcTime moment) const = 0;

  /// Returns the log time of the last reading of those sensors; nullopt if they have no reading.
  virtual Result<std::optional<Nanoseconds>, Failure> last_log_time(const std::vector<bool>& of_sensors) const = 0;

  /// Passes the other quantities of stations, from one log time on and before another, to `use`. Returns the number of
  /// impossible rows. Version 1 has none.
  virtual Result<std::size_t, Failure> each_quantities(Nanoseconds /*from*/, Nanoseconds /*to*/,
                                                       const UseQuantities& /*use*/) const {
    return std::size_t{0};
  }
};

}  // namespace yuragi::drivers::windlog
