#pragma once

#include <filesystem>
#include <optional>
#include <stop_token>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "drivers/windlog/log_moment.hpp"
#include "drivers/windlog/windlog_reader.hpp"

namespace yuragi::drivers::windlog {

/// The readings of the chosen sensors of a recording, from any place of it on, in the order of log time. Log time is
/// the recording's own: zero is its first reading, whichever sensor's that is.
///
/// Owns the open file. A Failure names the file that cannot be read; the next call tries the same place again.
/// Thread-safe: no. Realtime-safe: no; it reads a file.
class Cursor {
 public:
  /// `sensor`: its name; empty: the one with the first reading; "*": all of them. Fails also if there is no such
  /// sensor, or no reading at all. `stop`: a request of it ends this call, and later ones, within milliseconds with a
  /// failure.
  static Result<Cursor, Failure> open(const std::filesystem::path& file, std::string_view sensor,
                                      const std::stop_token& stop = {});

  /// Returns the next reading; nullopt at the end, until more has been recorded.
  Result<std::optional<LoggedReading>, Failure> next();

  /// Makes next() return the first reading at or after a log time.
  void seek(Nanoseconds log_time);

  /// Returns the log time of a place as a person writes it; for UTC that of the first reading at or after it, nullopt
  /// if all are before it.
  Result<std::optional<Nanoseconds>, Failure> find(const LogMoment& moment);

  /// The log time of the last reading, as of the opening.
  Nanoseconds last() const noexcept { return last_; }

  /// The median of the first intervals; one second if there are none, and never less than a millisecond.
  Nanoseconds interval() const noexcept { return interval_; }

  const Reader& reader() const noexcept { return reader_; }
  const LoggedSensor& sensor_of(const LoggedReading& logged) const { return reader_.sensors()[logged.sensor]; }

 private:
  explicit Cursor(Reader reader) : reader_(std::move(reader)) {}
  Result<void, Failure> choose(std::string_view sensor);
  Result<Nanoseconds, Failure> measure_interval();

  Reader reader_;
  Nanoseconds last_{0};
  Nanoseconds interval_{0};
};

}  // namespace yuragi::drivers::windlog
