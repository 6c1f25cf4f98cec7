#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <stop_token>
#include <string>

#include "daemon/history/step.hpp"
#include "drivers/windlog/sqlite.hpp"
#include "engine/base/result.hpp"
#include "engine/base/time.hpp"

namespace yuragi::daemon::history {

/// The length of the steps that are kept. They begin at multiples of it, UTC.
inline constexpr std::int64_t kKeptStep_s = 1800;

/// The file of means beside a recording: wall.windlog-means.
std::filesystem::path means_file_of(const std::filesystem::path& recording);

/// Where a sensor's readings in one file of a recording were read up to.
struct ReadPlace {
  std::int64_t recording_file = 0;  ///< the moment of its first reading, ns since 1970: it outlives a rename
  std::string sensor;
};

/// The steps of a recording's sensors, so that a year is not read reading by reading each time, and is still known when
/// old files of the recording are deleted. A file that comes back does not count again. A small SQLite database that
/// can be deleted at any time: it is made again from the recording's files that still exist. It grows by about 1 MB a
/// year and sensor.
///
/// Each change is one transaction with the place up to which was read: no reading counts twice, also after a crash or
/// with two daemons. Thread-safe: no. Realtime-safe: no; waits for the disk.
class MeansFile {
 public:
  /// Creates the file if it is missing. Fails with kBadData, as every call does, if it is damaged or of another
  /// version: then it is to be removed. `stop` makes the calls fail within milliseconds.
  static Result<MeansFile, Failure> open(const std::filesystem::path& file, const std::stop_token& stop = {});

  static void remove(const std::filesystem::path& file);

  /// The log time of the last reading that is in the steps, in that file; nullopt: none yet.
  Result<std::optional<Nanoseconds>, Failure> read_to(const ReadPlace& place);

  /// Adds steps by their beginnings (s since 1970, UTC) and moves the place from `before` to `read_to`. Fails with
  /// kUnavailable if another program moved it.
  Result<void, Failure> add(const ReadPlace& place, const std::optional<Nanoseconds>& before, Nanoseconds read_to,
                            const std::map<std::int64_t, Step>& steps);

  /// Is this completed file of the recording known in full at that size?
  Result<bool, Failure> has_all_of(const std::string& file_name, std::uint64_t bytes);
  Result<void, Failure> note_all_of(const std::string& file_name, std::uint64_t bytes);

  /// Passes the sum of each step of `step_s`, counted from `begin_s`, with readings: sensors in the order in which they
  /// became known.
  Result<void, Failure> each_step(
      std::int64_t begin_s, std::int64_t step_s, std::int64_t step_count,
      const std::function<void(const std::string& sensor, std::int64_t index, const Step& step)>& use);

 private:
  explicit MeansFile(drivers::windlog::sqlite::Database database) : database_(std::move(database)) {}
  Result<void, Failure> move_place(const ReadPlace& place, const std::optional<Nanoseconds>& before,
                                   Nanoseconds read_to);
  Result<void, Failure> add_steps(const std::string& sensor, const std::map<std::int64_t, Step>& steps);

  drivers::windlog::sqlite::Database database_;
};

}  // namespace yuragi::daemon::history
